/* LacedRing in C99: encodes index lists as streams, decodes streams, and has the corner operators on LR tables.
   Link with lacedring::core, which includes the functions of lacedring_decode.h. A program that only decodes lean
   streams needs nothing but lacedring_decode.h.

   The caller provides the memory of all results; functions free their temporary memory. A function that can fail
   returns an enum lacedring_code. If it has a parameter `message`, which may be null, it writes one line there that
   says what is wrong. Nothing here prints, exits or throws; functions may be called from several threads at once.
   Streams are little-endian 32-bit words. */
#ifndef LACEDRING_H
#define LACEDRING_H

#include <stddef.h>
#include <stdint.h>

#include "lacedring/lacedring_decode.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No vertex, corner or triangle: across a border, or not found. */
#define LACEDRING_NULL UINT32_MAX

#define LACEDRING_BLOCK 256 /* slots per block; the last block may have fewer */

enum lacedring_code {
    LACEDRING_CODE_OK = 0,
    LACEDRING_CODE_MALFORMED,        /* the words do not follow their format; an index names no vertex */
    LACEDRING_CODE_INVALID_ARGUMENT, /* an argument is out of its range */
    LACEDRING_CODE_TOO_SMALL,        /* a buffer; each function says how large it must be */
    LACEDRING_CODE_TOO_LARGE,        /* more elements than the format can number */
    LACEDRING_CODE_OUT_OF_MEMORY
};

/* Describes the code in English. Never null. */
const char* lacedring_code_string(int code);

/* One line without a file name, 0-terminated; longer messages are truncated. */
struct lacedring_message {
    char text[256];
};

/* As lacedring::Format (streams.hpp). docs/choosing.md says when to use which. */
enum lacedring_format {
    LACEDRING_FORMAT_LEAN = 0,      /* one vertex reference per triangle */
    LACEDRING_FORMAT_PACKED = 1,    /* little more than one bit per triangle, in blocks of 256 triangles */
    LACEDRING_FORMAT_LR = 2,        /* the standard LR tables: every corner operator in constant time */
    LACEDRING_FORMAT_LR_COMPACT = 3 /* the bit-efficient LR tables: the same operators in fewer bytes */
};

/* --- Encoding --- */

struct lacedring_encode_options {
    int format; /* enum lacedring_format */
    /* Packed only: 1 for an order that suits the vertex cache, in about 1.5 bits per triangle more; else 0. */
    int cache;
    int effort;           /* 0 to 9: time spent on better rings; default 6 */
    int no_wart_skipping; /* lean and lr only: 1 for no wart skipping; else 0 */
    /* Maximum number of threads, including the calling one; 0 means 1. The words do not depend on it. */
    int threads;
};

/* Sets packed, no cache order, effort 6, wart skipping, one thread. */
void lacedring_default_options(struct lacedring_encode_options* options);

/* Buffers that lacedring_encode fills. It skips those that are null, so set the struct to zero first. The counts are
   set whenever the mesh could be encoded, even if a buffer is too small. */
struct lacedring_encoded {
    uint32_t* words; /* the stream */
    size_t word_capacity, word_count;
    /* vertex_order[new] = old: bring the vertices' attributes into this order. */
    uint32_t* vertex_order;
    size_t vertex_capacity, vertex_count;
    /* triangle_order[i] = the mesh's triangle that is decoded i-th. */
    uint32_t* triangle_order;
    size_t triangle_capacity, triangle_count;
    uint32_t degenerate; /* triangles with a repeated vertex; they are not encoded */
};

/* Sets the three capacities to values that suffice for any mesh of that size, and nothing else. Real meshes need far
   fewer words: a third of the bound for lean, a thirtieth or less for packed and LR tables. To save memory, encode with
   a null `words` first, then again with word_count words. Errors: INVALID_ARGUMENT; TOO_LARGE (more than 2^32 indices,
   or a capacity exceeds size_t). */
enum lacedring_code lacedring_encode_bounds(int format, size_t index_count, uint32_t vertex_count,
                                            struct lacedring_encoded* encoded);

/* Encodes any triangle soup of index_count / 3 triangles. `options` null: the defaults. The words are the same on every
   machine. Linear time; about 70 bytes per triangle while it runs. Errors: MALFORMED (an index is not below
   vertex_count), INVALID_ARGUMENT (index_count is no multiple of three; an option is out of range), TOO_SMALL,
   TOO_LARGE, OUT_OF_MEMORY. */
enum lacedring_code lacedring_encode(const uint32_t* indices, size_t index_count, uint32_t vertex_count,
                                     const struct lacedring_encode_options* options, struct lacedring_encoded* encoded,
                                     struct lacedring_message* message);

/* --- Decoding --- */

/* A stream in memory. It points to the words, which must outlive it. In a packed stream every slot is a triangle; in
   the other formats some slots are empty. All functions below except lacedring_validate and lacedring_view require a
   valid stream. */
struct lacedring_stream {
    const uint32_t* words;
    size_t word_count;
    enum lacedring_format format;
    /* Decoded indices are below it; with LR tables it includes the copies of non-manifold vertices. */
    uint32_t vertices;
    uint32_t triangles; /* number of triangles that lacedring_decode_u32 decodes */
    uint32_t slots;
    uint32_t blocks;
};

/* Checks everything that decoders and operators rely on. Safe with any words: reads and memory are bounded. Linear
   time. Errors: MALFORMED, OUT_OF_MEMORY. */
enum lacedring_code lacedring_validate(const uint32_t* words, size_t word_count, struct lacedring_stream* stream,
                                       struct lacedring_message* message);

/* Reads the header and checks sizes only: for words just encoded or validated. The call itself is safe with any words,
   but the stream is valid only if the words are. Constant time; linear for LR tables. Errors: MALFORMED,
   OUT_OF_MEMORY. */
enum lacedring_code lacedring_view(const uint32_t* words, size_t word_count, struct lacedring_stream* stream,
                                   struct lacedring_message* message);

/* Decodes all triangles, 3 * stream->triangles indices, with the orientation they were encoded with. Linear time. For
   LR tables with copies, decode_u32 uses 4 bytes per vertex while it runs, and decode_u16 O(log copies) time per
   triangle. Errors: TOO_SMALL; INVALID_ARGUMENT (16 bits cannot number the vertices); OUT_OF_MEMORY. */
enum lacedring_code lacedring_decode_u32(const struct lacedring_stream* stream, uint32_t* indices, size_t capacity);
enum lacedring_code lacedring_decode_u16(const struct lacedring_stream* stream, uint16_t* indices, size_t capacity);

/* Decodes the triangles of one block, whose first slot is LACEDRING_BLOCK * block; sets *triangles to their number.
   Constant time; O(log copies) per triangle for LR tables with copies. Errors: INVALID_ARGUMENT (no such block),
   TOO_SMALL (3 * LACEDRING_BLOCK indices are always enough). */
enum lacedring_code lacedring_decode_block(const struct lacedring_stream* stream, uint32_t block, uint32_t* indices,
                                           size_t capacity, uint32_t* triangles);

/* Decodes the triangle of one slot. Returns 1; 0 if the slot is empty or does not exist. Cost per triangle: as
   lacedring_decode_block. */
int lacedring_decode_triangle(const struct lacedring_stream* stream, uint32_t slot, uint32_t triangle[3]);

/* --- LR tables: the corner operators, in constant time unless noted ---

   Corners must belong to triangles (see lacedring_is_triangle; the corners that operators return do). Vertices are
   below stream->vertices. For the argument LACEDRING_NULL an operator returns LACEDRING_NULL, or 0 if it returns a
   count or a truth value. */

/* The arrays of an LR stream; they point into its words. Corners are below 4 * slots; corner c belongs to triangle c /
   4. */
struct lacedring_tables {
    const uint32_t *lr, *vo, *star, *c, *copies;
    size_t lr_count, vo_count, star_count, c_count, copy_count;
    uint32_t vertices, ring_vertices, unit;
    enum lacedring_format format;
};

/* The tables of a valid stream. Errors: INVALID_ARGUMENT (the format has none). */
enum lacedring_code lacedring_open_tables(const struct lacedring_stream* stream, struct lacedring_tables* tables);

/* Is slot t a triangle? */
int lacedring_is_triangle(const struct lacedring_tables* tables, uint32_t t);
uint32_t lacedring_triangle(uint32_t corner); /* c.t */
/* t.c: the first corner; lacedring_next gives the others. */
uint32_t lacedring_corner_of_triangle(uint32_t t);
uint32_t lacedring_next(uint32_t corner);                                            /* c.n */
uint32_t lacedring_previous(uint32_t corner);                                        /* c.p */
uint32_t lacedring_vertex(const struct lacedring_tables* tables, uint32_t corner);   /* c.v */
uint32_t lacedring_opposite(const struct lacedring_tables* tables, uint32_t corner); /* c.o; null across a border */
uint32_t lacedring_left(const struct lacedring_tables* tables, uint32_t corner);     /* c.l = c.n.o */
uint32_t lacedring_right(const struct lacedring_tables* tables, uint32_t corner);    /* c.r = c.p.o */
/* c.s, around c.v; null at a border. */
uint32_t lacedring_swing(const struct lacedring_tables* tables, uint32_t corner);
/* v.c; null if no triangle uses v. */
uint32_t lacedring_corner_of_vertex(const struct lacedring_tables* tables, uint32_t v);
/* The vertex that v is a copy of, or v itself if it is not a copy. A non-manifold vertex has a copy for each further
   fan of triangles. O(log copies). */
uint32_t lacedring_original(const struct lacedring_tables* tables, uint32_t v);
/* Is v on a border? O(valence). */
int lacedring_is_border(const struct lacedring_tables* tables, uint32_t v);
/* Number of edges at v. O(valence), usually constant. */
uint32_t lacedring_valence(const struct lacedring_tables* tables, uint32_t v);
/* Writes the neighbors of v in swing order, at most `capacity`, and returns their number. O(valence). */
uint32_t lacedring_neighbors(const struct lacedring_tables* tables, uint32_t v, uint32_t* neighbors, uint32_t capacity);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_H */
