// Constants of the lean stream, included by C++ and GLSL. docs/lean-format.md specifies the format.
// Paper: LR 2011, section 7.
//
// A stream is LR_LEAN_HEADER_WORDS header words and then one word per *slot* of a triangle, all little-endian u32:
//     2 * rings2    two-sided rings: word 2v is the left slot of ring vertex v, word 2v+1 its right slot
//     rings1        one-sided rings: word of ring vertex v (rings2 <= v < rings2 + rings1), left side only
//     3 * verbatim  three vertices each
// Ring vertices are numbered along the rings, ring after ring. A ring slot's word is a vertex (the tip) and three
// flags.
#ifndef LACEDRING_LEAN_FORMAT_H
#define LACEDRING_LEAN_FORMAT_H

#define LR_LEAN_MAGIC 0x4e4c524cu  // "LRLN"
#define LR_LEAN_VERSION 1u

#define LR_LEAN_HEADER_WORDS 8u
#define LR_LEAN_WORD_MAGIC 0u
#define LR_LEAN_WORD_VERSION 1u
#define LR_LEAN_WORD_VERTICES 2u   // vertices of the mesh
#define LR_LEAN_WORD_RINGS2 3u     // vertices of two-sided rings
#define LR_LEAN_WORD_RINGS1 4u     // vertices of one-sided rings
#define LR_LEAN_WORD_VERBATIM 5u   // verbatim triangles
#define LR_LEAN_WORD_TRIANGLES 6u  // triangles of the mesh: slots minus degenerate ones
#define LR_LEAN_WORD_CHECKSUM 7u   // CRC-32 of the other seven words and the payload

#define LR_LEAN_TIP_MASK 0x1fffffffu  // the tip vertex
// A T0 in the redundant copy of a T2: the ring edge (v, v.n.n) skips the T2's tip.
#define LR_LEAN_WART_FLAG 0x80000000u
// No triangle: the edge closes its ring, and the tip is the ring's first vertex.
#define LR_LEAN_CLOSE_FLAG 0x40000000u
#define LR_LEAN_FLIP_FLAG 0x20000000u  // the input's triangle has the opposite orientation

#endif
