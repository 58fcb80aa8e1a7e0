/* LacedRing in C99: index lists into streams, streams into index lists, and the corner operators on LR tables.
   Link with lacedring::core, which also has what lacedring_decode.h declares. A program that decodes lean streams and
   nothing else needs lacedring_decode.h alone.

   All memory is the caller's; what a function needs while it runs it frees again. Functions that can fail return an
   enum lacedring_code, and where they take a `message` put one line there that says what is wrong (it may be null).
   Nothing here prints, exits or throws; functions may be called from several threads at once. Streams are
   little-endian 32-bit words. */
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

#define LACEDRING_BLOCK 256 /* slots of a block; the last block has what is left */

enum lacedring_code {
    LACEDRING_CODE_OK = 0,
    LACEDRING_CODE_MALFORMED,        /* the words do not follow their format; an index names no vertex */
    LACEDRING_CODE_INVALID_ARGUMENT, /* an argument is out of its range */
    LACEDRING_CODE_TOO_SMALL,        /* a buffer; what it must hold is said where it is described */
    LACEDRING_CODE_TOO_LARGE,        /* more elements than the format numbers */
    LACEDRING_CODE_OUT_OF_MEMORY
};

/* The code as a phrase, for people. Never null. */
const char* lacedring_code_string(int code);

/* One line without the name of a file, ending with 0, cut off where it is longer. */
struct lacedring_message {
    char text[256];
};

/* As lacedring::Format (streams.hpp); docs/choosing.md says which for what. */
enum lacedring_format {
    LACEDRING_FORMAT_LEAN = 0,      /* one vertex reference a triangle */
    LACEDRING_FORMAT_PACKED = 1,    /* little more than one bit a triangle, blocks of 256 */
    LACEDRING_FORMAT_LR = 2,        /* the standard LR tables: every corner operator in constant time */
    LACEDRING_FORMAT_LR_COMPACT = 3 /* the bit-efficient LR tables: the same operators in fewer bytes */
};

/* --- Encoding --- */

struct lacedring_encode_options {
    int format;           /* enum lacedring_format */
    int cache;            /* packed: not 0 for an order that suits the vertex cache, in about one bit and a half more */
    int effort;           /* 0 to 9: how long to look for good rings; 6 is the default */
    int no_wart_skipping; /* lean and lr: not 0 for none */
    int threads; /* run on at most that many, the calling one included; 0 as 1. The same words for any number */
};

/* packed, small, effort 6, wart skipping, one thread. */
void lacedring_default_options(struct lacedring_encode_options* options);

/* Buffers that lacedring_encode fills. A null pointer: not wanted, so set all to zero first. The counts are set if the
   mesh could be encoded, even where a buffer is too small for them. */
struct lacedring_encoded {
    uint32_t* words; /* the stream */
    size_t word_capacity, word_count;
    uint32_t* vertex_order; /* vertex_order[new] = old: bring the vertices' attributes into this order */
    size_t vertex_capacity, vertex_count;
    uint32_t* triangle_order; /* triangle_order[i] = the mesh's triangle decoded i-th */
    size_t triangle_capacity, triangle_count;
    uint32_t degenerate; /* triangles with a repeated vertex, which are left out */
};

/* Sets the three capacities to what is enough for any mesh of that size, and nothing else. Real meshes take far fewer
   words: a third of that for lean, a thirtieth and less for packed and LR tables. Where so much memory is not to be
   had, encode with a null `words`, and again with word_count words. Errors: INVALID_ARGUMENT; TOO_LARGE (past 2^32
   indices, or size_t). */
enum lacedring_code lacedring_encode_bounds(int format, size_t index_count, uint32_t vertex_count,
                                            struct lacedring_encoded* encoded);

/* Encodes index_count / 3 triangles, indices below vertex_count: any triangle soup. `options` null: the defaults. The
   same words on every machine. Linear time; about 60 bytes a triangle while it runs. Errors: MALFORMED (an index),
   INVALID_ARGUMENT (index_count is no multiple of three; an option), TOO_SMALL, TOO_LARGE, OUT_OF_MEMORY. */
enum lacedring_code lacedring_encode(const uint32_t* indices, size_t index_count, uint32_t vertex_count,
                                     const struct lacedring_encode_options* options, struct lacedring_encoded* encoded,
                                     struct lacedring_message* message);

/* --- Decoding --- */

/* A stream in memory. Holds no copy: the words must stay. In a packed stream every slot is a triangle; in the other
   formats some slots have none. All functions below but lacedring_validate and lacedring_view want a valid stream. */
struct lacedring_stream {
    const uint32_t* words;
    size_t word_count;
    enum lacedring_format format;
    uint32_t vertices;  /* decoded indices are below it; with LR tables, copies of non-manifold vertices included */
    uint32_t triangles; /* decoded by lacedring_decode_u32 */
    uint32_t slots;
    uint32_t blocks;
};

/* Checks all that decoders and operators rely on, of any words: bounded reads and memory. Linear time. Errors:
   MALFORMED, OUT_OF_MEMORY. */
enum lacedring_code lacedring_validate(const uint32_t* words, size_t word_count, struct lacedring_stream* stream,
                                       struct lacedring_message* message);

/* Reads the header and checks sizes only: for what was just encoded or validated. Safe by itself with any words, but
   what it returns is valid only if they are. Constant time, linear for LR tables. Errors: MALFORMED, OUT_OF_MEMORY. */
enum lacedring_code lacedring_view(const uint32_t* words, size_t word_count, struct lacedring_stream* stream,
                                   struct lacedring_message* message);

/* All triangles, 3 * stream->triangles indices, oriented as they were encoded. Linear time. LR tables with copies take
   4 bytes a vertex while they are decoded to 32 bits, and O(log copies) a triangle to 16 bits. Errors: TOO_SMALL;
   INVALID_ARGUMENT (more vertices than 16 bits number); OUT_OF_MEMORY. */
enum lacedring_code lacedring_decode_u32(const struct lacedring_stream* stream, uint32_t* indices, size_t capacity);
enum lacedring_code lacedring_decode_u16(const struct lacedring_stream* stream, uint16_t* indices, size_t capacity);

/* The triangles of slots LACEDRING_BLOCK * block and on, of one block, and how many they are. Constant time; O(log
   copies) a triangle for LR tables with copies. Errors: INVALID_ARGUMENT (no such block), TOO_SMALL (3 *
   LACEDRING_BLOCK indices are always enough). */
enum lacedring_code lacedring_decode_block(const struct lacedring_stream* stream, uint32_t block, uint32_t* indices,
                                           size_t capacity, uint32_t* triangles);

/* The triangle of one slot. Returns 1; 0 if the slot has none, or there is no such slot. Cost: as a block's. */
int lacedring_decode_triangle(const struct lacedring_stream* stream, uint32_t slot, uint32_t triangle[3]);

/* --- LR tables: the corner operators, each in constant time but for those that say otherwise ---

   They take corners of triangles (lacedring_is_triangle; what the operators themselves return) and vertices below
   stream->vertices. LACEDRING_NULL in gives LACEDRING_NULL out, or 0 where a number or a truth value is returned. */

/* The arrays of an LR stream, where they lie. Corners are below 4 * slots, and corner c is one of triangle c / 4. */
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
uint32_t lacedring_triangle(uint32_t corner);      /* c.t */
uint32_t lacedring_corner_of_triangle(uint32_t t); /* t.c: the first; next gives the others */
uint32_t lacedring_next(uint32_t corner);          /* c.n */
uint32_t lacedring_previous(uint32_t corner);      /* c.p */
uint32_t lacedring_vertex(const struct lacedring_tables* tables, uint32_t corner);   /* c.v */
uint32_t lacedring_opposite(const struct lacedring_tables* tables, uint32_t corner); /* c.o; null across a border */
uint32_t lacedring_left(const struct lacedring_tables* tables, uint32_t corner);     /* c.l = c.n.o */
uint32_t lacedring_right(const struct lacedring_tables* tables, uint32_t corner);    /* c.r = c.p.o */
uint32_t lacedring_swing(const struct lacedring_tables* tables,
                         uint32_t corner); /* c.s, around c.v; null at a border */
uint32_t lacedring_corner_of_vertex(const struct lacedring_tables* tables,
                                    uint32_t v); /* v.c; null for a vertex of no triangle */
/* The vertex that v is a copy of, for another fan of triangles; v itself if it is none. O(log copies). */
uint32_t lacedring_original(const struct lacedring_tables* tables, uint32_t v);
/* Is v on a border? O(valence). */
int lacedring_is_border(const struct lacedring_tables* tables, uint32_t v);
/* Edges at v. O(valence), mostly constant. */
uint32_t lacedring_valence(const struct lacedring_tables* tables, uint32_t v);
/* Writes the neighbors of v in swing order, `capacity` at most, and returns how many there are. O(valence). */
uint32_t lacedring_neighbors(const struct lacedring_tables* tables, uint32_t v, uint32_t* neighbors, uint32_t capacity);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_H */
