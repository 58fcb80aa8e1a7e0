/* The WebAssembly module of js/src/core.js: lean and packed streams. JavaScript copies a file into memory, calls these
   functions with addresses after it (js/src/engine.js allocates them), and reads numbers from `lr_result` and arrays
   from the addresses it gave. All input is checked. Functions that can fail return an enum lacedring_status. */
#include "lacedring_decode.h"

#define LR_EXPORT(name) __attribute__((export_name(#name))) name

/* What a function returns besides its status: numbers, and in words 8 and 9 the `where` of an error. */
static uint32_t result[10];
#define LR_WHERE ((uint64_t*)(void*)(result + 8))

uint32_t* LR_EXPORT(lr_result)(void) {
    return result;
}

/* Product of two polynomials modulo that of CRC-32. The highest bit is the coefficient of x^0. */
static uint32_t crc_product(uint32_t a, uint32_t b) {
    uint32_t product = 0;
    for (; a != 0; a <<= 1) {
        if (a >> 31) product ^= b;
        b = (b >> 1) ^ (0xedb88320u & (0 - (b & 1)));
    }
    return product;
}

/* The CRC of a times x^(8 size). That is the CRC of a || b, xor the CRC of b, for any b of `size` bytes. */
static uint32_t crc_before(uint32_t crc, size_t size) {
    uint32_t power = 0x00800000u;
    for (; size != 0; size >>= 1, power = crc_product(power, power)) {
        if (size & 1) crc = crc_product(crc, power);
    }
    return crc;
}

#ifdef LACEDRING_TINY
#define CRC_TABLES 1
#else
#define CRC_TABLES 8

static uint32_t crc_step(uint32_t tables[CRC_TABLES][256], const uint8_t* bytes, uint32_t crc) {
    uint32_t low, high;
    memcpy(&low, bytes, 4);
    memcpy(&high, bytes + 4, 4);
    low ^= crc;
    return tables[7][low & 255] ^ tables[6][low >> 8 & 255] ^ tables[5][low >> 16 & 255] ^ tables[4][low >> 24] ^
           tables[3][high & 255] ^ tables[2][high >> 8 & 255] ^ tables[1][high >> 16 & 255] ^ tables[0][high >> 24];
}
#endif

/* Continues a CRC-32 with `size` more bytes. `crc`: that of the bytes before, 0 if there are none. */
uint32_t LR_EXPORT(lr_crc)(const uint8_t* bytes, size_t size, uint32_t crc) {
    static uint32_t tables[CRC_TABLES][256];
    uint32_t i, k;
    if (tables[0][1] == 0) {
        for (i = 0; i < 256; ++i) {
            uint32_t entry = i;
            for (k = 0; k < 8; ++k) entry = (entry >> 1) ^ (0xedb88320u & (0 - (entry & 1)));
            tables[0][i] = entry;
        }
        for (k = 1; k < CRC_TABLES; ++k) {
            for (i = 0; i < 256; ++i) tables[k][i] = (tables[k - 1][i] >> 8) ^ tables[0][tables[k - 1][i] & 255];
        }
    }
    crc = ~crc;
#ifndef LACEDRING_TINY
    if (size >= 4096) { /* three parts at once, so that their table loads overlap */
        const size_t part = size / 24 * 8;
        uint32_t second = 0, third = 0;
        for (i = 0; i < part; i += 8) {
            crc = crc_step(tables, bytes + i, crc);
            second = crc_step(tables, bytes + part + i, second);
            third = crc_step(tables, bytes + 2 * part + i, third);
        }
        crc = crc_before(crc_before(crc, part) ^ second, part) ^ third;
        bytes += 3 * part;
        size -= 3 * part;
    }
    for (; size >= 8; size -= 8, bytes += 8) crc = crc_step(tables, bytes, crc);
#endif
    for (; size > 0; --size) crc = (crc >> 8) ^ tables[0][(crc ^ *bytes++) & 255];
    return ~crc;
}

/* Checks that word `at` of a stream is the CRC of words [from, at) and all words after it. The stream is the end of a
   section that begins at `contents` and whose CRC is `crc`, so that only bytes up to word `at` need to be read. */
static uint32_t checksum_of(const uint32_t* words, size_t count, size_t from, size_t at, const uint8_t* contents,
                            uint32_t crc) {
    uint32_t before = lr_crc((const uint8_t*)(words + from), 4 * (at - from), 0);
    before ^= lr_crc(contents, (size_t)((const uint8_t*)(words + at + 1) - contents), 0);
    crc ^= crc_before(before, 4 * (count - at - 1));
    return crc == words[at] ? LACEDRING_STATUS_OK : LACEDRING_STATUS_CHECKSUM;
}

static struct lacedring_lean lean;
static struct lacedring_packed packed;
static uint32_t is_packed;

/* Opens a lean or packed stream; `crc` is the CRC of its words. Result: vertices, triangles, slots. */
uint32_t LR_EXPORT(lr_connectivity_open)(const uint32_t* words, size_t count, uint32_t crc) {
    uint32_t status;
    is_packed = count > 0 && (words[0] & 0xffffff) == 0x50524c;
    if (is_packed) {
        status = lacedring_packed_open(words, count, &packed, LR_WHERE);
        if (status != LACEDRING_STATUS_OK) return status;
        result[0] = packed.vertices;
        result[1] = result[2] = packed.triangles;
        return checksum_of(words, count, 0, LACEDRING_PACKED_HEADER_WORDS - 1, (const uint8_t*)words, crc);
    }
    status = lacedring_lean_open(words, count, &lean, LR_WHERE);
    if (status != LACEDRING_STATUS_OK) return status;
    result[0] = lean.vertices;
    result[1] = lean.triangles;
    result[2] = lacedring_lean_slots(&lean);
    return checksum_of(words, count, 0, LACEDRING_LEAN_HEADER_WORDS - 1, (const uint8_t*)words, crc);
}

/* Checks the stream opened last, and writes its triangles, three vertices each. */
uint32_t LR_EXPORT(lr_connectivity_decode)(uint32_t* out) {
    uint32_t status;
    if (is_packed) {
        status = lacedring_packed_decode_checked(&packed, out, LR_WHERE);
    } else {
        status = lacedring_lean_check(&lean, LR_WHERE);
        if (status == LACEDRING_STATUS_OK) lacedring_lean_triangles_u32(&lean, out);
    }
    return status;
}

/* Decodes one triangle (or slot of a lean stream) of the stream opened last, which lr_connectivity_decode accepted.
   Result: its three vertices. */
void LR_EXPORT(lr_triangle)(uint32_t triangle) {
    if (is_packed) {
#ifdef LACEDRING_TINY /* smaller code: decodes a whole block */
        uint32_t block[3 * LACEDRING_PACKED_BLOCK], run = 0, turned = 0;
        if (triangle >= packed.own) {
            while (triangle >= lacedring_run_end_(&packed, run)) ++run;
            turned = packed.doubles[2 * run + 1] >> 31;
            triangle += (packed.doubles[2 * run + 1] & 0x7fffffff) - packed.doubles[2 * run];
        }
        lacedring_own_blocks_(&packed, triangle / LACEDRING_PACKED_BLOCK, triangle / LACEDRING_PACKED_BLOCK + 1, block);
        lacedring_double_(block + 3 * (triangle % LACEDRING_PACKED_BLOCK), turned, result);
#else
        lacedring_packed_triangle(&packed, triangle, result);
#endif
    } else {
        lacedring_lean_slot(&lean, triangle, result);
    }
}
