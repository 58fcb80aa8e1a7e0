/* Decodes LacedRing's storage form of seam sections straight into the copies of corners, without making the resident
   section. C99 or C++; one file beside lacedring_storage.h, lacedring_seams.h and what these include, no allocation.
   Format: docs/storage-format.md, "Seams".

   Define LACEDRING_DECODE_IMPLEMENTATION in one .c or .cpp file before including this header, which then adds the
   functions. A program that links lacedring::core has them already.

   `triangles` are the slots of the mesh's connectivity stream, as in lacedring_seams.h.

       struct lacedring_stored_seams seams;
       if (lacedring_stored_seams_open(words, count, vertex_count, triangle_count, most_copies, &seams, NULL) !=
           LACEDRING_STATUS_OK) ...
       void *scratch = malloc(lacedring_stored_seams_scratch(&seams));
       uint32_t *copies = malloc(12 * (size_t)triangle_count), *vertex_of = malloc(4 * (size_t)most_copies);
       if (lacedring_stored_seams_decode(&seams, triangles, scratch, copies, vertex_of, NULL) !=
           LACEDRING_STATUS_OK) ...

   All functions are safe with any words and triangles: they read and write only the memory described here, and take
   time linear in the words and the limits that the caller gives. Scratch memory must be aligned as by malloc. Stored
   words are little-endian, and this file is for little-endian machines. */
#ifndef LACEDRING_STORED_SEAMS_H
#define LACEDRING_STORED_SEAMS_H

#include "lacedring_seams.h"
#include "lacedring_storage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A seam section in storage form. Refers to the caller's words. */
struct lacedring_stored_seams {
    const uint32_t* words;
    size_t count;
    uint32_t vertices, triangles; /* of the mesh */
    uint32_t most_copies;         /* most copies allowed */
    uint32_t copies;              /* number of copies; set by decoding */
};

/* Checks the sizes that the caller gives; the section has no header. most_copies: the number in the file, or what fits
   in memory; decoding more returns LACEDRING_STATUS_LIMIT. Constant time. */
enum lacedring_status lacedring_stored_seams_open(const uint32_t* words, size_t count, uint32_t vertices,
                                                  uint32_t triangles, uint32_t most_copies,
                                                  struct lacedring_stored_seams* stored, uint64_t* where);

/* Bytes of scratch memory for lacedring_stored_seams_decode: 33 per triangle, of which it seldom touches more than 13,
   24 per vertex, and 4 per copy of stored->most_copies. Returns SIZE_MAX if the number does not fit in size_t. */
size_t lacedring_stored_seams_scratch(const struct lacedring_stored_seams* stored);

/* Decodes the copy of each corner, three per slot (UINT32_MAX in empty slots), and the vertex of each copy:
   stored->copies entries of vertex_of, which has room for stored->most_copies. The result is that of
   lacedring_seams_decode_checked for the resident section. On an error the contents of `copies` and `vertex_of` are
   undefined. 24 KB of stack. */
enum lacedring_status lacedring_stored_seams_decode(struct lacedring_stored_seams* stored, const uint32_t* triangles,
                                                    void* scratch, uint32_t* copies, uint32_t* vertex_of,
                                                    uint64_t* where);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_STORED_SEAMS_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_STORED_SEAMS_IMPLEMENTED)
#define LACEDRING_STORED_SEAMS_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_NONE_ UINT32_MAX
#define LACEDRING_SEAM_CORNERS_ (3 * LACEDRING_SEAMS_BLOCK)
/* Most homes from the corners of a vertex; the copies at its two ring edges may be added. */
#define LACEDRING_MOST_HOMES_ 253u

/* The arithmetic decoder. `number` lies in the interval [low, high] that remains after the bits decoded so far. */
struct lacedring_seam_bits_ {
    const uint32_t* words;
    /* Number of words, and how many were read. Words after the last are 0. */
    size_t count, at;
    uint64_t low, high, number;
};

LACEDRING_SMALL_ uint32_t lacedring_seam_word_(struct lacedring_seam_bits_* d) {
    const size_t at = d->at++;
    return at < d->count ? d->words[at] : 0;
}

/* Decodes a bit that is 0 with probability zero / 2^15. */
LACEDRING_SMALL_ uint32_t lacedring_seam_split_(struct lacedring_seam_bits_* d, uint32_t zero) {
    const uint64_t middle = d->low + ((d->high - d->low) >> 15) * zero;
    const uint32_t bit = d->number > middle;
    d->low = bit ? middle + 1 : d->low;
    d->high = bit ? d->high : middle;
    while ((d->low ^ d->high) >> 32 == 0) {
        d->low <<= 32;
        d->high = d->high << 32 | UINT32_MAX;
        d->number = d->number << 32 | lacedring_seam_word_(d);
    }
    return bit;
}

/* Decodes a bit by an adaptive model. */
static uint32_t lacedring_seam_bit_(struct lacedring_seam_bits_* d, struct lacedring_bit_model_* m) {
    const uint32_t bit = lacedring_seam_split_(d, m->zero), seen = m->seen < 48 ? m->seen + 1u : 48u;
    const int32_t zero = m->zero, to = bit ? 32 : 32768 - 32;
    m->seen = (uint16_t)seen;
    m->zero = (uint16_t)(zero + (((to - zero) * (int32_t)lacedring_bit_steps_[seen]) >> 16));
    return bit;
}

/* What is known of a vertex, or, as the end of a side, of the vertex at the side's other end. */
enum {
    LACEDRING_SINGLE_,     /* it has one copy */
    LACEDRING_UNDECIDED_,  /* nothing yet */
    LACEDRING_SEVERAL_,    /* it has several copies, not decoded yet */
    LACEDRING_DECODED_,    /* its copies are decoded */
    LACEDRING_SEAM_THERE_, /* of a side's end only: decoded, and the edge is a seam at that end */
    LACEDRING_EDGE_ENDS_
};
/* Kinds of an edge at a decoded vertex. */
enum { LACEDRING_INNER_, LACEDRING_SEAM_, LACEDRING_BORDER_ };

struct lacedring_seam_vertex_ {
    /* Where its corners begin in lacedring_seam_copies_::own; they end where those of the next vertex begin. */
    uint32_t begin;
    /* Temporary: a side or corner of another vertex that leads here, or LACEDRING_NONE_. */
    uint32_t mark;
    uint32_t below, above; /* neighbors on the stack, if it is there */
    uint8_t status, is_stacked;
    /* Number of its edges that are seams at their other end, at most 2. */
    uint8_t seams;
    /* Has it more than one copy? A section may say that a vertex has several and then name only one. */
    uint8_t has_copies;
};

/* Decodes which corners of a vertex share a copy. The corners of a vertex are numbered j = 0, 1 ...; side 2 j is the
   edge of corner j to the next vertex of its triangle, side 2 j + 1 the edge to the one before. */
struct lacedring_seam_copies_ {
    struct lacedring_seam_bits_ bits;
    const uint32_t* triangles;
    uint32_t vertex_count;
    struct lacedring_seam_vertex_* vertices; /* one per vertex, and one more */
    uint32_t* own;                           /* corners of each vertex, in increasing order */
    /* For each corner, a preliminary number of its copy: the vertex for its first copy, else a number that is not a
       vertex. */
    uint32_t* copies;
    uint32_t count; /* copies so far */
    uint32_t top;   /* top of the stack, or LACEDRING_NONE_ */
    uint32_t bad;   /* nonzero: a copy is invalid */
    /* The vertex being decoded. far: for each side, the corner at its other end. mate: for each side, the side of
       another corner at the same edge, or LACEDRING_NONE_. copy: for each corner, its copy, from 0, or
       LACEDRING_NONE_. */
    uint32_t *far, *mate, *copy;
    /* known: its copies so far. left: corners not decoded. since: corners decoded since the last whose copy no link
       gave. at_seam: 1 if the fan began at an end LACEDRING_SEAM_THERE_. */
    uint32_t known, left, since, at_seam;
    /* Models of docs/storage-format.md: first is A, neighbor G, across B, between C, either D, other E, is_new F. */
    struct lacedring_bit_model_ first[2], neighbor[3][3];
    struct lacedring_bit_model_ across[LACEDRING_EDGE_ENDS_][3][4][4],
        between[LACEDRING_EDGE_ENDS_][LACEDRING_EDGE_ENDS_][3];
    struct lacedring_bit_model_ either[LACEDRING_EDGE_ENDS_][LACEDRING_EDGE_ENDS_][3], other[LACEDRING_EDGE_ENDS_][3];
    struct lacedring_bit_model_ is_new[2][3][2];
};

LACEDRING_SMALL_ uint32_t lacedring_seam_least_(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* The corner `by` corners after this one in its triangle. */
LACEDRING_SMALL_ uint32_t lacedring_seam_turn_(uint32_t corner, uint32_t by) {
    const uint32_t place = corner % 3;
    return corner + by - (place + by < 3 ? 0 : 3);
}

/* Decodes whether a vertex has several copies, if that is still open. */
static void lacedring_seam_decide_(struct lacedring_seam_copies_* w, uint32_t v, struct lacedring_bit_model_* m) {
    struct lacedring_seam_vertex_* p = w->vertices + v;
    if (p->status != LACEDRING_UNDECIDED_) return;
    p->status = p[1].begin - p->begin > 1 && lacedring_seam_bit_(&w->bits, m) ? LACEDRING_SEVERAL_ : LACEDRING_SINGLE_;
}

/* Removes a vertex from anywhere in the stack. */
static void lacedring_seam_unstack_(struct lacedring_seam_copies_* w, uint32_t v) {
    struct lacedring_seam_vertex_* p = w->vertices + v;
    p->is_stacked = 0;
    if (p->below != LACEDRING_NONE_) w->vertices[p->below].above = p->above;
    *(p->above != LACEDRING_NONE_ ? &w->vertices[p->above].below : &w->top) = p->below;
}

/* Puts a vertex on top of the stack; moves it there if it is on the stack already. */
static void lacedring_seam_stack_(struct lacedring_seam_copies_* w, uint32_t v) {
    struct lacedring_seam_vertex_* p = w->vertices + v;
    if (p->is_stacked) lacedring_seam_unstack_(w, v);
    p->is_stacked = 1;
    p->below = w->top;
    p->above = LACEDRING_NONE_;
    if (w->top != LACEDRING_NONE_) w->vertices[w->top].above = v;
    w->top = v;
}

/* Sets far and mate of the vertex's sides. */
static void lacedring_seam_link_(struct lacedring_seam_copies_* w, const uint32_t* own, uint32_t n) {
    uint32_t s;
    for (s = 0; s < 2 * n; ++s) {
        const uint32_t far = lacedring_seam_turn_(own[s / 2], 1 + s % 2);
        uint32_t* mark = &w->vertices[w->triangles[far]].mark;
        w->far[s] = far;
        w->mate[s] = *mark;
        if (*mark != LACEDRING_NONE_) w->mate[*mark] = s;
        *mark = *mark != LACEDRING_NONE_ ? LACEDRING_NONE_ : s;
    }
    for (s = 0; s < 2 * n; ++s) w->vertices[w->triangles[w->far[s]]].mark = LACEDRING_NONE_;
}

/* The end of a side: what is known of the vertex at its other end. */
LACEDRING_SMALL_ uint32_t lacedring_seam_edge_end_(const struct lacedring_seam_copies_* w, uint32_t side) {
    const uint32_t far = w->far[side], mate = w->mate[side], status = w->vertices[w->triangles[far]].status;
    if (status == LACEDRING_DECODED_ && mate != LACEDRING_NONE_ && w->copies[far] != w->copies[w->far[mate]])
        return LACEDRING_SEAM_THERE_;
    return status;
}

/* Reads the copy of a corner that has none of the `count` copies of its links. */
static uint32_t lacedring_seam_other_(struct lacedring_seam_copies_* w, const uint32_t* links, uint32_t count) {
    const uint32_t rest = w->known - count, left = lacedring_seam_least_(w->left, 2);
    uint32_t bits, index = 0, low, high;
    w->since = 0;
    if (rest == 0 || lacedring_seam_bit_(&w->bits, &w->is_new[rest > 1][left][w->at_seam])) return w->known++;
    for (bits = 0; (rest - 1) >> bits != 0; ++bits) index = 2 * index + lacedring_seam_split_(&w->bits, 16384);
    if (index >= rest) {
        w->bad = 1;
        return 0;
    }
    low = count == 2 && links[1] < links[0] ? links[1] : links[0];
    high = count == 2 && links[1] < links[0] ? links[0] : links[1];
    if (count > 0 && index >= low) ++index;
    if (count > 1 && index >= high) ++index;
    return index;
}

/* Reads the copy of a side's corner, which was reached across this side. */
static uint32_t lacedring_seam_read_copy_(struct lacedring_seam_copies_* w, uint32_t side) {
    uint32_t end[2] = {0, 0}, link[2] = {0, 0}, count = 0, n, k;
    for (k = 0; k < 2; ++k) { /* links: sides to corners that are decoded */
        const uint32_t mate = w->mate[side ^ k];
        if (mate == LACEDRING_NONE_ || w->copy[mate / 2] == LACEDRING_NONE_) continue;
        end[count] = lacedring_seam_edge_end_(w, side ^ k);
        link[count++] = w->copy[mate / 2];
    }
    --w->left;
    n = lacedring_seam_least_(w->known, 3) - 1;
    if (count == 1) {
        const uint32_t since = lacedring_seam_least_(w->since, 3), left = lacedring_seam_least_(w->left, 3);
        if (lacedring_seam_bit_(&w->bits, &w->across[end[0]][n][since][left])) return link[0];
    } else if (count == 2) {
        /* `low` is the link with the lesser end. */
        const uint32_t low = end[1] < end[0], high = 1 - low;
        if (link[0] == link[1]) {
            if (lacedring_seam_bit_(&w->bits, &w->between[end[low]][end[high]][n])) return link[0];
            count = 1;
        } else {
            if (lacedring_seam_bit_(&w->bits, &w->either[end[low]][end[high]][n])) return link[low];
            if (lacedring_seam_bit_(&w->bits, &w->other[end[high]][n])) return link[high];
        }
    }
    return lacedring_seam_other_(w, link, count);
}

/* Decodes the copies of a fan that begins at side `start`: from its corner on, away from the side; then from its mate's
   corner on, in the other direction. */
static void lacedring_seam_fan_copies_(struct lacedring_seam_copies_* w, uint32_t start, uint32_t at_seam) {
    const uint32_t mate = w->mate[start];
    uint32_t half;
    w->at_seam = at_seam;
    for (half = 0; half < 2; ++half) {
        uint32_t s = half == 0 ? start : mate;
        w->since = 0;
        while (s != LACEDRING_NONE_ && w->copy[s / 2] == LACEDRING_NONE_) {
            w->copy[s / 2] = lacedring_seam_read_copy_(w, s);
            ++w->since;
            s = w->mate[s ^ 1];
        }
    }
}

/* Decodes whether each neighbor of a decoded vertex has several copies. Pushes the neighbors with several copies on the
   stack; neighbors across seams end up on top. */
static void lacedring_seam_neighbors_(struct lacedring_seam_copies_* w, uint32_t sides) {
    /* One entry per edge, in reused arrays: each entry overwrites a side that was handled already. */
    uint32_t *vertex = w->far, *kind = w->mate;
    uint32_t s, edges = 0, seam;
    for (s = 0; s < sides; ++s) {
        const uint32_t mate = w->mate[s], v = w->triangles[w->far[s]];
        if (mate < s) continue; /* the edge was handled at its mate */
        seam = mate != LACEDRING_NONE_ && w->copy[s / 2] != w->copy[mate / 2];
        if (seam && w->vertices[v].seams < 2) ++w->vertices[v].seams;
        vertex[edges] = v;
        kind[edges++] = mate == LACEDRING_NONE_ ? LACEDRING_BORDER_ : seam ? LACEDRING_SEAM_ : LACEDRING_INNER_;
    }
    for (s = 0; s < edges; ++s)
        lacedring_seam_decide_(w, vertex[s], &w->neighbor[kind[s]][w->vertices[vertex[s]].seams]);
    for (seam = 0; seam < 2; ++seam) {
        for (s = 0; s < edges; ++s) {
            if ((kind[s] == LACEDRING_SEAM_) == seam && w->vertices[vertex[s]].status == LACEDRING_SEVERAL_)
                lacedring_seam_stack_(w, vertex[s]);
        }
    }
}

/* Decodes the copies of the corners of a vertex that has several. */
static void lacedring_seam_vertex_copies_(struct lacedring_seam_copies_* w, uint32_t v) {
    const uint32_t* own = w->own + w->vertices[v].begin;
    const uint32_t n = w->vertices[v + 1].begin - w->vertices[v].begin;
    uint32_t s;
    lacedring_seam_link_(w, own, n);
    w->known = 0;
    w->left = n;
    memset(w->copy, 0xff, 4 * (size_t)n);
    for (s = 0; s < 2 * n; ++s) {
        if (w->copy[s / 2] == LACEDRING_NONE_ && lacedring_seam_edge_end_(w, s) == LACEDRING_SEAM_THERE_)
            lacedring_seam_fan_copies_(w, s, 1);
    }
    for (s = 0; s < 2 * n; ++s) {
        if (w->copy[s / 2] == LACEDRING_NONE_ && w->mate[s] == LACEDRING_NONE_) lacedring_seam_fan_copies_(w, s, 0);
    }
    for (s = 0; s < 2 * n; s += 2) {
        if (w->copy[s / 2] == LACEDRING_NONE_) lacedring_seam_fan_copies_(w, s, 0);
    }
    for (s = 0; s < n; ++s) w->copies[own[s]] = w->copy[s] == 0 ? v : w->count + w->copy[s] - 1;
    w->count += w->known - 1;
    w->vertices[v].has_copies = w->known > 1;
    w->vertices[v].status = LACEDRING_DECODED_;
    lacedring_seam_neighbors_(w, 2 * n);
}

/* Lists the corners of all vertices. Returns the number of an invalid triangle, or triangle_count. */
static uint32_t lacedring_seam_own_corners_(struct lacedring_seam_copies_* w, uint32_t triangle_count) {
    const uint32_t vertex_count = w->vertex_count;
    struct lacedring_seam_vertex_* p = w->vertices;
    uint32_t i, v, begin = 0;
    memset(p, 0, sizeof *p * ((size_t)vertex_count + 1));
    for (i = 0; i < triangle_count; ++i) {
        const uint32_t* t = w->triangles + 3 * (size_t)i;
        if ((t[0] & t[1] & t[2]) == UINT32_MAX) continue;
        if (t[0] >= vertex_count || t[1] >= vertex_count || t[2] >= vertex_count || t[0] == t[1] || t[1] == t[2] ||
            t[2] == t[0])
            return i;
        ++p[t[0]].mark;
        ++p[t[1]].mark;
        ++p[t[2]].mark;
    }
    for (v = 0; v < vertex_count; ++v) {
        const uint32_t n = p[v].mark;
        p[v].begin = p[v].mark = begin;
        p[v].status = LACEDRING_UNDECIDED_;
        begin += n;
    }
    p[vertex_count].begin = begin;
    for (i = 0; i < 3 * triangle_count; ++i) {
        if (w->triangles[i] != UINT32_MAX) w->own[p[w->triangles[i]].mark++] = i;
    }
    for (v = 0; v < vertex_count; ++v) p[v].mark = LACEDRING_NONE_;
    return triangle_count;
}

/* Decodes the preliminary copies of all corners. */
static enum lacedring_status lacedring_seam_all_copies_(struct lacedring_seam_copies_* w, uint32_t most,
                                                        uint64_t* where) {
    uint32_t v, before = 0;
    for (v = 0; v < w->vertex_count; ++v) {
        lacedring_seam_decide_(w, v, w->first + before);
        before = w->vertices[v].status != LACEDRING_SINGLE_;
        if (w->vertices[v].status == LACEDRING_SEVERAL_) lacedring_seam_stack_(w, v);
        while (w->top != LACEDRING_NONE_) {
            const uint32_t u = w->top;
            lacedring_seam_unstack_(w, u);
            lacedring_seam_vertex_copies_(w, u);
            if (w->bad) return lacedring_at_(where, u, LACEDRING_STATUS_COPY);
            if (w->count > most) return lacedring_at_(where, w->count, LACEDRING_STATUS_LIMIT);
        }
        if (w->bits.at > w->bits.count + 1) return lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
    }
    return LACEDRING_STATUS_OK;
}

/* Gives copies their numbers in the resident section. Counts the flags that a reader of that section would read: the
   decoding of its table needs the counts. */
struct lacedring_seam_numbers_ {
    const struct lacedring_seam_vertex_* vertices;
    uint32_t* vertex_of;
    uint32_t* home; /* as from lacedring_seams_homes */
    /* For each preliminary copy: its number among the homes of its vertex, or the state of a private copy, or
       LACEDRING_NONE_. */
    uint32_t* state;
    /* For each triangle: how far before it its parent is, plus 128 if it is on the right. */
    uint8_t* parents;
    uint32_t* of_block;                          /* preliminary copies of the block's corners */
    uint32_t counts[LACEDRING_SEAM_CONTEXTS][2]; /* flags with value 0 and 1 */
    struct lacedring_seam_walk_ walk;
};

/* Collects the fan of vertex v: its corners in order from edge (v, v + 1) toward v - 1 (by = 1), or from edge (v, v -
   1) toward v + 1 (by = 2), as far as triangles follow. Returns their number. */
static uint32_t lacedring_seam_fan_(struct lacedring_seam_copies_* w, uint32_t v, uint32_t by, uint32_t* fan) {
    const uint32_t* own = w->own + w->vertices[v].begin;
    const uint32_t n = w->vertices[v + 1].begin - w->vertices[v].begin;
    const uint32_t stop = by == 1 ? v - 1 : v + 1;
    uint32_t at = by == 1 ? v + 1 : v - 1, count = 0, j;
    uint8_t* taken = (uint8_t*)w->copy;
    for (j = n; j-- > 0;) {
        /* The loop runs backwards, so that the mark of the first corner at a vertex stays. */
        w->vertices[w->triangles[lacedring_seam_turn_(own[j], by)]].mark = j;
        taken[j] = 0;
    }
    while ((count == 0 || at != stop) && at < w->vertex_count) {
        j = w->vertices[at].mark;
        if (j == LACEDRING_NONE_ || taken[j]) break;
        taken[j] = 1;
        fan[count++] = own[j];
        at = w->triangles[lacedring_seam_turn_(own[j], 3 - by)];
    }
    for (j = 0; j < n; ++j) w->vertices[w->triangles[lacedring_seam_turn_(own[j], by)]].mark = LACEDRING_NONE_;
    return count;
}

/* Adds a copy to homes unless it is among them or they are full. Returns the number of homes. */
static uint32_t lacedring_seam_add_home_(const struct lacedring_seam_numbers_* a, uint32_t copy, uint32_t* homes,
                                         uint32_t count) {
    if (a->state[copy] != LACEDRING_NONE_ || count == LACEDRING_MOST_HOMES_) return count;
    a->state[copy] = 0;
    homes[count] = copy;
    return count + 1;
}

/* Moves a copy to the front of homes, or to the end. Returns the number of homes. */
static uint32_t lacedring_seam_move_home_(uint32_t copy, uint32_t to_front, uint32_t* homes, uint32_t count) {
    uint32_t i = 0;
    while (i < count && homes[i] != copy) ++i;
    if (i == count) ++count; /* it was not among the 253 */
    if (to_front) {
        memmove(homes + 1, homes, 4 * (size_t)i);
        homes[0] = copy;
    } else {
        memmove(homes + i, homes + i + 1, 4 * (size_t)(count - 1 - i));
        homes[count - 1] = copy;
    }
    return count;
}

/* Finds the homes of a vertex that has several copies. Sets their states and *wraps. Returns their number. */
static uint32_t lacedring_seam_find_homes_(struct lacedring_seam_copies_* w, const struct lacedring_seam_numbers_* a,
                                           uint32_t v, uint32_t* wraps) {
    const uint32_t *own = w->own + w->vertices[v].begin, *triangles = w->triangles;
    const uint32_t n = w->vertices[v + 1].begin - w->vertices[v].begin;
    uint32_t homes[LACEDRING_MOST_HOMES_ + 3];
    uint32_t ends[2] = {LACEDRING_NONE_, LACEDRING_NONE_}; /* copies at the ring edges to v - 1 and v + 1 */
    uint32_t *fan = w->far, count = 0, changes = 0, size, left, i, k;
    size = lacedring_seam_fan_(w, v, 1, fan);
    for (i = 0; i < size / 2; ++i) { /* reverses the fan */
        const uint32_t swap = fan[i];
        fan[i] = fan[size - 1 - i];
        fan[size - 1 - i] = swap;
    }
    if (size == 0) size = lacedring_seam_fan_(w, v, 2, fan);
    for (i = left = 0; i < size; ++i) {
        /* Keeps the copies of the corners on the left, in place of the corners. */
        if (a->parents[fan[i] / 3] < 128) fan[left++] = w->copies[fan[i]];
    }
    for (i = 0; i < left; ++i) {
        count = lacedring_seam_add_home_(a, fan[i], homes, count);
        changes += i > 0 && fan[i] != fan[i - 1];
    }
    for (i = 0; i < n; ++i) {
        const uint32_t x = triangles[lacedring_seam_turn_(own[i], 1)], y = triangles[lacedring_seam_turn_(own[i], 2)];
        if (a->parents[own[i] / 3] >= 128) continue;
        count = lacedring_seam_add_home_(a, w->copies[own[i]], homes, count);
        for (k = 0; k < 2; ++k) {
            const uint32_t to = k == 0 ? v - 1 : v + 1;
            if (ends[k] == LACEDRING_NONE_ && (x == to || y == to)) ends[k] = w->copies[own[i]];
        }
    }
    if (count == 0) homes[count++] = w->copies[own[0]];
    if (count > 1) {
        if (ends[1] != LACEDRING_NONE_ && ends[1] != ends[0])
            count = lacedring_seam_move_home_(ends[1], 0, homes, count);
        if (ends[0] != LACEDRING_NONE_) count = lacedring_seam_move_home_(ends[0], 1, homes, count);
    }
    for (i = 0; i < count; ++i) a->state[homes[i]] = i;
    *wraps = count > 1 && changes == count && fan[0] == fan[left - 1];
    return count;
}

/* Has one of `count` corners, given by their vertices, a vertex with several copies? */
static int lacedring_seam_any_copies_(const struct lacedring_seam_vertex_* vertices, const uint32_t* corners,
                                      uint32_t count) {
    uint32_t k;
    for (k = 0; k < count; ++k) {
        if (corners[k] != UINT32_MAX && vertices[corners[k]].has_copies) return 1;
    }
    return 0;
}

/* Sets the parents and sides of a block's triangles. */
static void lacedring_seam_find_parents_(const uint32_t* triangles, uint32_t count, uint8_t* parents) {
    uint32_t i, pair[2];
    for (i = 0; i < count; ++i) {
        const uint32_t* t = triangles + 3 * (size_t)i;
        uint32_t back, side;
        if (lacedring_seam_is_empty(t)) continue;
        back = lacedring_seam_parent(triangles, i, pair);
        side = lacedring_seam_side(t);
        if (side == 2) side = back > 0 ? parents[i - back] / 128u : 0;
        parents[i] = (uint8_t)(back | side << 7);
    }
}

/* Counts a flag of this value, and returns the value. */
LACEDRING_SMALL_ uint32_t lacedring_seam_answer_(struct lacedring_seam_numbers_* a, uint32_t context, uint32_t value) {
    ++a->counts[context][value];
    return value;
}

/* Counts the flags that lacedring_seam_vertices_ would read for a block of vertices. */
static void lacedring_seam_answer_vertices_(struct lacedring_seam_numbers_* a, const uint32_t* home, uint32_t count) {
    uint32_t i, before = 0;
    if ((home[count] >> 1) - (home[0] >> 1) == count) return; /* blocks that make no copies are not counted */
    for (i = 0; i < count; ++i) {
        const uint32_t wraps = home[i] & 1, steps = (home[i + 1] >> 1) - (home[i] >> 1) - 1 + wraps;
        if (lacedring_seam_answer_(a, LACEDRING_SEAM_V0 + before, steps > 0) &&
            lacedring_seam_answer_(a, LACEDRING_SEAM_MORE, steps > 1)) {
            uint32_t k = 2;
            while (k < LACEDRING_SEAMS_MAX_STEPS && lacedring_seam_answer_(a, LACEDRING_SEAM_MANY, steps > k)) ++k;
            lacedring_seam_answer_(a, LACEDRING_SEAM_WRAP, wraps);
        }
        before = lacedring_seam_least_(steps, 2);
    }
}

/* Counts the flags that lacedring_seam_choose_ would read, and returns the corner's state. A new private copy gets its
   number. */
static uint32_t lacedring_seam_answer_choice_(struct lacedring_seam_numbers_* a, uint32_t k, uint32_t current,
                                              struct lacedring_seam_question_ q) {
    struct lacedring_seam_walk_* w = &a->walk;
    uint32_t* state = a->state + a->of_block[k];
    const uint32_t is_new = *state == LACEDRING_NONE_, is_home = *state < LACEDRING_SEAMS_PRIVATE;
    uint32_t left = w->steps[k] + 1 - (w->home[k] & 1), asked = LACEDRING_NONE_, made;
    if (current < LACEDRING_SEAMS_PRIVATE) {
        asked = lacedring_seam_copy_(w, k, current);
        --left;
    }
    made = q.new_first && lacedring_seam_answer_(a, q.new_context, is_new);
    if (!made && q.at_context != LACEDRING_SEAM_NONE) {
        const uint32_t at = lacedring_seam_copy_(w, k, q.at);
        if (at != asked) {
            if (lacedring_seam_answer_(a, q.at_context, at == *state)) return q.at;
            --left;
        }
    }
    if (made || (!q.new_first && lacedring_seam_answer_(a, q.new_context, is_new)))
        *state = LACEDRING_SEAMS_PRIVATE | w->made++;
    else if (left > 0)
        lacedring_seam_answer_(a, LACEDRING_SEAM_HOME, is_home);
    return *state;
}

/* Counts the flags that lacedring_seam_spoke_ would read, and sets the states of the edge's ends. */
static void lacedring_seam_answer_spoke_(struct lacedring_seam_numbers_* a, uint32_t i, uint32_t back,
                                         const uint32_t pair[2]) {
    struct lacedring_seam_walk_* w = &a->walk;
    struct lacedring_seam_end_ end[2];
    const uint32_t context = lacedring_seam_ends_(w, i, back, pair, end, end + 1);
    uint32_t changes[2], k;
    for (k = 0; k < 2; ++k) {
        const uint32_t c = end[k].corner;
        changes[k] = lacedring_seam_copy_(w, c, end[k].state) != a->state[a->of_block[c]];
    }
    if (lacedring_seam_answer_(a, context, changes[0] | changes[1]))
        lacedring_seam_answer_(a, end[0].type == 0 ? LACEDRING_SEAM_HALF : LACEDRING_SEAM_BOTH,
                               changes[1] && changes[0] == (context != LACEDRING_SEAM_LONE));
    for (k = 0; k < 2; ++k) {
        w->state[end[k].corner] = end[k].state;
        if (changes[k])
            w->state[end[k].corner] = lacedring_seam_answer_choice_(a, end[k].corner, end[k].state,
                                                                    lacedring_seam_change_(w, w->side[i], end + k));
    }
}

/* Counts the flags of triangle i, whose vertices have one copy each. */
static void lacedring_seam_answer_plain_(struct lacedring_seam_numbers_* a, uint32_t i, const uint32_t pair[2]) {
    struct lacedring_seam_walk_* w = &a->walk;
    const uint32_t* t = w->triangles + 3 * (size_t)i;
    const uint32_t is_left = w->side[i] == 0, has_parent = pair[0] < 3;
    uint32_t j;
    if (has_parent) lacedring_seam_answer_(a, is_left ? LACEDRING_SEAM_LONE : LACEDRING_SEAM_RIGHT1, 0);
    for (j = 0; j < 3; ++j) {
        w->state[3 * i + j] = 0;
        if (j == pair[0] || j == pair[1]) continue;
        lacedring_seam_answer_(
            a,
            is_left ? LACEDRING_SEAM_START_L
            : has_parent && (lacedring_seam_corner(t, t[j] - 1) < 3 || lacedring_seam_corner(t, t[j] + 1) < 3)
                ? LACEDRING_SEAM_PLAIN
                : LACEDRING_SEAM_MID_R,
            1);
    }
}

/* Numbers the copies of a block in which some vertex has several. */
static void lacedring_seam_number_block_(struct lacedring_seam_numbers_* a, const uint8_t* parents) {
    struct lacedring_seam_walk_* w = &a->walk;
    uint32_t i, j;
    lacedring_seam_gather_(w, a->home);
    for (i = 0; i < w->count; ++i) {
        const uint32_t back = parents[i] & 127u;
        const uint32_t* t = w->triangles + 3 * (size_t)i;
        uint32_t pair[2] = {3, 3};
        if (lacedring_seam_is_empty(t)) continue;
        w->side[i] = parents[i] >> 7;
        if (back > 0) lacedring_seam_pair(t, t - 3 * (size_t)back, pair);
        if (!lacedring_seam_any_copies_(a->vertices, t, 3)) {
            lacedring_seam_answer_plain_(a, i, pair);
            continue;
        }
        if (back > 0) lacedring_seam_answer_spoke_(a, i, back, pair);
        for (j = 0; j < 3; ++j) {
            const uint32_t k = 3 * i + j;
            if (j != pair[0] && j != pair[1])
                w->state[k] =
                    lacedring_seam_answer_choice_(a, k, LACEDRING_NONE_, lacedring_seam_start_(w, i, j, back > 0));
        }
    }
}

/* Numbers all copies: replaces preliminary numbers by those of the section, and sets vertex_of. */
static void lacedring_seam_number_copies_(struct lacedring_seam_copies_* w, struct lacedring_seam_numbers_* a,
                                          uint32_t triangle_count) {
    const uint32_t blocks = lacedring_seam_block_count_(triangle_count);
    uint32_t block, v, k, first = 0, count = 1;
    for (block = 0; block < blocks; ++block) {
        const uint32_t* t = w->triangles + (size_t)block * LACEDRING_SEAM_CORNERS_;
        const uint32_t size = lacedring_seam_block_size_(triangle_count, block);
        if (lacedring_seam_any_copies_(w->vertices, t, 3 * size))
            lacedring_seam_find_parents_(t, size, a->parents + (size_t)block * LACEDRING_SEAMS_BLOCK);
    }
    memset(a->state, 0xff, 4 * (size_t)w->count);
    for (v = 0; v < w->vertex_count; ++v) {
        uint32_t wraps = 0, homes = 1;
        a->state[v] = 0;
        if (w->vertices[v].has_copies) {
            a->state[v] = LACEDRING_NONE_;
            homes = lacedring_seam_find_homes_(w, a, v, &wraps);
        }
        a->home[v] = 2 * first + wraps;
        for (k = 0; k < homes; ++k) a->vertex_of[first++] = v;
    }
    a->home[v] = 2 * first;
    for (v = 0; v < w->vertex_count; v += count) {
        count = lacedring_seam_least_(w->vertex_count - v, LACEDRING_SEAMS_BLOCK);
        lacedring_seam_answer_vertices_(a, a->home + v, count);
    }
    a->walk.made = 0;
    for (block = 0; block < blocks; ++block) {
        const size_t corner = (size_t)block * LACEDRING_SEAM_CORNERS_;
        const uint32_t* t = w->triangles + corner;
        uint32_t* copies = w->copies + corner;
        const uint32_t size = lacedring_seam_block_size_(triangle_count, block);
        const int any_copies = lacedring_seam_any_copies_(w->vertices, t, 3 * size);
        if (any_copies) {
            a->walk.triangles = t;
            a->walk.count = size;
            a->of_block = copies;
            lacedring_seam_number_block_(a, a->parents + (size_t)block * LACEDRING_SEAMS_BLOCK);
        }
        for (k = 0; k < 3 * size; ++k) {
            uint32_t state;
            if (t[k] == UINT32_MAX) continue;
            state = any_copies ? a->state[copies[k]] : 0;
            if (state < LACEDRING_SEAMS_PRIVATE) {
                copies[k] = (a->home[t[k]] >> 1) + state;
            } else {
                copies[k] = first + (state - LACEDRING_SEAMS_PRIVATE);
                a->vertex_of[copies[k]] = t[k];
            }
        }
    }
}

/* Reads the section's table and drops it: only then can the caller check that the words end here. */
static void lacedring_seam_read_table_(struct lacedring_seam_bits_* d, const struct lacedring_seam_numbers_* a) {
    struct lacedring_bit_model_ is_usual[2], classes[7][8];
    uint32_t c, bit;
    lacedring_begin_bits_(is_usual, 2);
    lacedring_begin_bits_(classes[0], 7 * 8);
    for (c = 0; c < LACEDRING_SEAM_CONTEXTS; ++c) {
        const uint32_t* counts = a->counts[c];
        const uint32_t all = counts[0] + counts[1], usual = counts[1] > counts[0];
        const uint32_t likely = usual ^ lacedring_seam_bit_(d, is_usual + (all > 0)), rare = counts[1 - likely];
        uint32_t rarity = all > 0, node = 1;
        if (rare > 0) {
            while (rarity < 6 && (all / rare) >> (rarity - 1) != 0) ++rarity;
        }
        for (bit = 0; bit < 3; ++bit) node = 2 * node + lacedring_seam_bit_(d, classes[rarity] + node);
    }
}

enum lacedring_status lacedring_stored_seams_open(const uint32_t* words, size_t count, uint32_t vertices,
                                                  uint32_t triangles, uint32_t most_copies,
                                                  struct lacedring_stored_seams* s, uint64_t* where) {
    if (most_copies > LACEDRING_SEAMS_MAX_COPIES) most_copies = LACEDRING_SEAMS_MAX_COPIES;
    if (vertices > most_copies) return lacedring_at_(where, vertices, LACEDRING_STATUS_LIMIT);
    if (triangles > (UINT32_MAX - vertices) / 3) return lacedring_at_(where, triangles, LACEDRING_STATUS_LIMIT);
    s->words = words;
    s->count = count;
    s->vertices = vertices;
    s->triangles = triangles;
    s->most_copies = most_copies;
    if (most_copies - vertices > 3 * triangles) s->most_copies = vertices + 3 * triangles;
    s->copies = 0;
    return LACEDRING_STATUS_OK;
}

size_t lacedring_stored_seams_scratch(const struct lacedring_stored_seams* s) {
    const size_t vertices = lacedring_bytes_of_(sizeof(struct lacedring_seam_vertex_) + 4, s->vertices,
                                                (uint32_t)sizeof(struct lacedring_seam_vertex_) + 4);
    return lacedring_bytes_of_(lacedring_bytes_of_(vertices, s->triangles, 33), s->most_copies, 4);
}

enum lacedring_status lacedring_stored_seams_decode(struct lacedring_stored_seams* s, const uint32_t* triangles,
                                                    void* scratch, uint32_t* copies, uint32_t* vertex_of,
                                                    uint64_t* where) {
    const size_t triangle_count = s->triangles;
    struct lacedring_seam_copies_ w;
    struct lacedring_seam_numbers_ a;
    enum lacedring_status status;
    uint32_t i;
    memset(&w.bits, 0, sizeof w.bits);
    w.bits.words = s->words;
    w.bits.count = s->count;
    w.bits.high = UINT64_MAX;
    w.bits.number = lacedring_seam_word_(&w.bits);
    w.bits.number = w.bits.number << 32 | lacedring_seam_word_(&w.bits);
    w.triangles = triangles;
    w.vertices = (struct lacedring_seam_vertex_*)scratch;
    a.home = (uint32_t*)(void*)(w.vertices + s->vertices + 1);
    w.own = a.home + s->vertices + 1;
    w.far = w.own + 3 * triangle_count;
    w.mate = w.far + 2 * triangle_count;
    w.copy = w.mate + 2 * triangle_count;
    a.state = w.copy + triangle_count;
    a.parents = (uint8_t*)(a.state + s->most_copies);
    a.vertices = w.vertices;
    w.copies = copies;
    a.vertex_of = vertex_of;
    w.vertex_count = w.count = s->vertices;
    w.top = LACEDRING_NONE_;
    w.bad = 0;
    lacedring_begin_bits_(w.first, sizeof w.first / sizeof w.first[0]);
    lacedring_begin_bits_(w.neighbor[0], sizeof w.neighbor / sizeof w.first[0]);
    lacedring_begin_bits_(w.across[0][0][0], sizeof w.across / sizeof w.first[0]);
    lacedring_begin_bits_(w.between[0][0], sizeof w.between / sizeof w.first[0]);
    lacedring_begin_bits_(w.either[0][0], sizeof w.either / sizeof w.first[0]);
    lacedring_begin_bits_(w.other[0], sizeof w.other / sizeof w.first[0]);
    lacedring_begin_bits_(w.is_new[0][0], sizeof w.is_new / sizeof w.first[0]);
    i = lacedring_seam_own_corners_(&w, s->triangles);
    if (i < s->triangles) return lacedring_at_(where, i, LACEDRING_STATUS_TRIANGLE);
    if (triangle_count > 0) memcpy(copies, triangles, 12 * triangle_count);
    status = lacedring_seam_all_copies_(&w, s->most_copies, where);
    if (status != LACEDRING_STATUS_OK) return status;
    memset(a.counts, 0, sizeof a.counts);
    lacedring_seam_number_copies_(&w, &a, s->triangles);
    lacedring_seam_read_table_(&w.bits, &a);
    if (w.bits.at != w.bits.count + 1 || w.bits.number != ((w.bits.low >> 32) + 1) << 32)
        return lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
    s->copies = w.count;
    return LACEDRING_STATUS_OK;
}

#undef LACEDRING_NONE_
#undef LACEDRING_SEAM_CORNERS_
#undef LACEDRING_MOST_HOMES_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
