// The packed stream's constants, read by C++ and by GLSL. docs/packed-format.md has the whole format.
//
// A stream is LR_PACKED_HEADER_WORDS header words, and then, all little-endian u32:
//     turn bits    one bit a triangle, LR_PACKED_BLOCK_WORDS words a block, the last block's cut short
//     directory    for each group of LR_PACKED_GROUP blocks: the byte at which its records begin, and the length of
//     each
//                  record in bytes, four to a word
//     records      one for each block, of whole bytes, the first bit lowest; zeros up to a whole word at the end
//     tail         LR_PACKED_TAIL_WORDS zeros, so that a reader may load eight bytes anywhere in a record
#ifndef LACEDRING_PACKED_FORMAT_H
#define LACEDRING_PACKED_FORMAT_H

#define LR_PACKED_MAGIC 0x4b50524cu  // "LRPK"
#define LR_PACKED_VERSION 1u

#define LR_PACKED_HEADER_WORDS 8u
#define LR_PACKED_WORD_MAGIC 0u
#define LR_PACKED_WORD_VERSION 1u
#define LR_PACKED_WORD_VERTICES 2u
#define LR_PACKED_WORD_TRIANGLES 3u
#define LR_PACKED_WORD_RECORD_BYTES 4u  // of all records
#define LR_PACKED_WORD_WIDTHS 5u        // bits of a vertex, and of the low part of a gap << 8
#define LR_PACKED_WORD_RESERVED 6u      // zero
#define LR_PACKED_WORD_CHECKSUM 7u      // CRC-32 of the other seven words and all that follows

#define LR_PACKED_BLOCK 256u      // triangles of a block; the last block has what is left
#define LR_PACKED_BLOCK_WORDS 8u  // their turn bits
#define LR_PACKED_TAIL_WORDS 2u
#define LR_PACKED_MIN_GAP_BITS 3u
#define LR_PACKED_GROUP 16u       // blocks of a directory group
#define LR_PACKED_GROUP_WORDS 5u  // its words; the last group's are cut short

// A record's length as the directory has it: up to LR_PACKED_MAX_RECORD bytes of events; or LR_PACKED_PLAIN, three
// vertices a triangle as they are; or between these, LR_PACKED_PARTS records of so many triangles each, behind a word
// with their lengths, 8 * (length - LR_PACKED_MAX_RECORD) bytes in all.
#define LR_PACKED_MAX_RECORD 160u
#define LR_PACKED_PLAIN 255u
#define LR_PACKED_PARTS 4u
#define LR_PACKED_PART 64u       // triangles of a part
#define LR_PACKED_PART_WORDS 2u  // their turn bits

// Corridors put aside in a record; the one put aside first is forgotten where there are more.
#define LR_PACKED_STACK 16u

// Event codes: so many ones before the zero. The last code has no zero.
#define LR_PACKED_WART 0u    // at its triangle: a T0 with a T2 beside it
#define LR_PACKED_SPLIT 1u   // at its triangle: a T0 with a longer corridor beside it
#define LR_PACKED_BESIDE 2u  // before its triangle: a corridor that begins where the one before began or ended
#define LR_PACKED_START 3u   // before its triangle: another corridor
#define LR_PACKED_FAR 4u     // at its triangle: any third vertex
#define LR_PACKED_JUMP 5u    // at its triangle: a third vertex on the chain, and no corridor up to it
#define LR_PACKED_END 6u     // before its triangle: the corridor ends
#define LR_PACKED_TURN 7u    // before its triangle: the orientation changes

// What a corridor's start says, after its code: so many ones before the zero.
#define LR_PACKED_START_OTHER 0u  // the other side of the polygon begun last
#define LR_PACKED_START_NEXT 1u   // the left side of the polygon behind it
#define LR_PACKED_START_NEAR 2u   // a polygon that begins little behind where that one did
#define LR_PACKED_START_ANY 3u    // any

// Which vertex the next field is counted from, where a corridor begins beside another.
#define LR_PACKED_BESIDE_NOW_B 0u    // a, from the b where that one ended
#define LR_PACKED_BESIDE_NOW_A 1u    // b, from the a where it ended
#define LR_PACKED_BESIDE_BEGUN_A 2u  // a, from the a where it began
#define LR_PACKED_BESIDE_BEGUN_B 3u  // b, from the b where it began

// Orders of the Exp-Golomb codes.
#define LR_PACKED_SPLIT_ORDER 2u
#define LR_PACKED_JUMP_ORDER 1u
#define LR_PACKED_SIZE_ORDER 2u
#define LR_PACKED_BESIDE_ORDER 1u

#endif
