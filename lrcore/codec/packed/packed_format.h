// Constants of the packed stream, included by C++ and GLSL. docs/packed-format.md specifies the format. A "double"
// has the same vertices as an earlier triangle; "own" triangles are all others.
//
// A stream is LR_PACKED_HEADER_WORDS header words, and then, all little-endian u32:
//     turn bits    one bit per own triangle, LR_PACKED_BLOCK_WORDS words per block; the last block has fewer
//     table        for each group of LR_PACKED_GROUP blocks but the first: the word at which it begins
//     doubles      LR_PACKED_DOUBLES_WORDS words and runs of LR_PACKED_RUN_WORDS, if the header says that there are any
//     groups       a head each, of bits, and then a record for each block, of whole bytes; zeros up to a whole word
#ifndef LACEDRING_PACKED_FORMAT_H
#define LACEDRING_PACKED_FORMAT_H

#define LR_PACKED_MAGIC 0x3250524cu  // "LRP2"

#define LR_PACKED_HEADER_WORDS 4u
#define LR_PACKED_WORD_MAGIC 0u
#define LR_PACKED_WORD_VERTICES 1u   // bit LR_PACKED_DOUBLES: there are doubles
#define LR_PACKED_WORD_TRIANGLES 2u  // own triangles
#define LR_PACKED_WORD_CHECKSUM 3u   // CRC-32 of the other three words and all that follows

// Doubles: their number and the number of runs; then for each run its first triangle and the own triangle it doubles.
// LR_PACKED_DOUBLES in the vertices' word: there are doubles; in a run: its triangles are reversed.
#define LR_PACKED_DOUBLES 0x80000000u
#define LR_PACKED_DOUBLES_WORDS 2u
#define LR_PACKED_RUN_WORDS 2u

#define LR_PACKED_BLOCK 256u      // triangles per block; the last block may have fewer
#define LR_PACKED_BLOCK_WORDS 8u  // turn bits of a block
#define LR_PACKED_GROUP 16u       // blocks per group; the last group may have fewer

// A group's head begins with a word of these fields (sizes in bits), in this order. Then follow: for each block except
// the first, a bit that is set if the block has its own entry; the entry of the first block and all own entries, two
// vertices and an orientation each; the kind of each block, if there are kinds; the end of each block's record; and for
// each block except the first its entry step, relative to the last block with its own entry.
#define LR_PACKED_STEP_FIELD 12u   // approximate bytes of a record
#define LR_PACKED_OFFSET_FIELD 5u  // bits of a record's end, at most 16
#define LR_PACKED_ENTRY_FIELD 4u   // bits of an entry step, at most 12
#define LR_PACKED_GAP_FIELD 3u     // low bits of the gap before an event
#define LR_PACKED_WART_FIELD 3u    // low bits of the gap before a wart
#define LR_PACKED_SPLIT_FIELD 2u   // order of a split's size
#define LR_PACKED_COUNT_FIELD 2u   // order of the number of events
#define LR_PACKED_KINDS_FIELD 1u   // 1: blocks have kinds
#define LR_PACKED_HEAD_BITS 32u
#define LR_PACKED_MAX_OFFSET_BITS 16u
#define LR_PACKED_MAX_ENTRY_BITS 12u

// Kinds of blocks.
#define LR_PACKED_KIND_BITS 2u
#define LR_PACKED_RECORD 0u  // a record of at most LR_PACKED_MAX_RECORD bytes
// A byte with the length of each part, then LR_PACKED_PARTS records of LR_PACKED_PART triangles each.
#define LR_PACKED_PARTED 1u
#define LR_PACKED_PLAIN 2u  // three vertices per triangle
#define LR_PACKED_MAX_RECORD 160u
#define LR_PACKED_PARTS 4u
#define LR_PACKED_MAX_PART 200u
#define LR_PACKED_PART 64u  // triangles of a part

// Event codes, written in unary; the last code has no zero. To add a code, see docs/packed-format.md, "Changing the
// format".
#define LR_PACKED_EVENT_CODES 7u
#define LR_PACKED_SPLIT 0u  // at its triangle: a T0; the polygon's smaller part comes next
// Before its triangle: a corridor that begins near the beginning or the end of the previous corridor.
#define LR_PACKED_BESIDE 1u
#define LR_PACKED_START 2u  // before its triangle: another corridor
#define LR_PACKED_FAR 3u    // at its triangle: any third vertex
// At its triangle: a third vertex on the chain; the corridor up to it is skipped or has a given number of triangles.
#define LR_PACKED_JUMP 4u
#define LR_PACKED_TURN 5u  // before its triangle: the orientation changes
// Before its triangle: a bit for each triangle of the record, set if it has the opposite orientation.
#define LR_PACKED_FLIPS 6u

// Kinds of START, written in unary after its code.
#define LR_PACKED_START_OTHER 0u  // the other side of the last polygon begun
#define LR_PACKED_START_NEXT 1u   // the left side of the polygon after the last one begun
#define LR_PACKED_START_NEAR 2u   // a polygon starting a small offset after the last one begun
#define LR_PACKED_START_ANY 3u    // any polygon

// Kinds of BESIDE: the vertex that the next field gives, and the vertex it is relative to.
#define LR_PACKED_BESIDE_NOW_B 0u    // a, relative to the b where the previous corridor ended
#define LR_PACKED_BESIDE_NOW_A 1u    // b, relative to the a where the previous corridor ended
#define LR_PACKED_BESIDE_BEGUN_A 2u  // a, relative to the a where the previous corridor began
#define LR_PACKED_BESIDE_BEGUN_B 3u  // b, relative to the b where the previous corridor began

// Orders of the exponential Golomb codes.
#define LR_PACKED_JUMP_ORDER 1u
#define LR_PACKED_SIZE_ORDER 2u
#define LR_PACKED_BESIDE_ORDER 1u
#define LR_PACKED_FAR_ORDER 2u

#endif
