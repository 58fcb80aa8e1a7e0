// The packed stream's constants, read by C++ and by GLSL. docs/packed-format.md has the whole format.
//
// A stream is LR_PACKED_HEADER_WORDS header words, and then, all little-endian u32:
//     turn bits    one bit an own triangle (no double), LR_PACKED_BLOCK_WORDS words a block, the last block's cut short
//     table        for each group of LR_PACKED_GROUP blocks but the first: the word at which it begins
//     doubles      LR_PACKED_DOUBLES_WORDS words and runs of LR_PACKED_RUN_WORDS, if the header says that there are any
//     groups       a head each, of bits, and then a record for each block, of whole bytes; zeros up to a whole word
#ifndef LACEDRING_PACKED_FORMAT_H
#define LACEDRING_PACKED_FORMAT_H

#define LR_PACKED_MAGIC 0x3250524cu  // "LRP2"

#define LR_PACKED_HEADER_WORDS 4u
#define LR_PACKED_WORD_MAGIC 0u
#define LR_PACKED_WORD_VERTICES 1u   // or LR_PACKED_DOUBLES
#define LR_PACKED_WORD_TRIANGLES 2u  // own ones
#define LR_PACKED_WORD_CHECKSUM 3u   // CRC-32 of the other three words and all that follows

// Doubles: how many, how many runs; a run: its first triangle, the own triangle that this one is the double of.
#define LR_PACKED_DOUBLES 0x80000000u  // of the vertices' word: there are any; of a run: they are turned round
#define LR_PACKED_DOUBLES_WORDS 2u
#define LR_PACKED_RUN_WORDS 2u

#define LR_PACKED_BLOCK 256u      // triangles of a block; the last block has what is left
#define LR_PACKED_BLOCK_WORDS 8u  // their turn bits
#define LR_PACKED_GROUP 16u       // blocks of a group; the last group has what is left

// Bits of a field of a group's head, in this order: one word. Then for each block but the first a bit, whether it has
// an entry of its own; the entries, the first block's before these, two vertices and an orientation each; for each
// block its kind, if there are kinds; for each block where its record ends; for each block but the first its entry,
// from that of the last block that has its own.
#define LR_PACKED_STEP_FIELD 12u   // bytes of a record, about
#define LR_PACKED_OFFSET_FIELD 5u  // bits of an end, at most 16
#define LR_PACKED_ENTRY_FIELD 4u   // bits of an entry, at most 12
#define LR_PACKED_GAP_FIELD 3u     // low bits of the gap before an event
#define LR_PACKED_WART_FIELD 3u    // low bits of the gap before a wart
#define LR_PACKED_SPLIT_FIELD 2u   // order of a split's size
#define LR_PACKED_COUNT_FIELD 2u   // order of the number of events
#define LR_PACKED_KINDS_FIELD 1u   // are there kinds?
#define LR_PACKED_HEAD_BITS 32u
#define LR_PACKED_MAX_OFFSET_BITS 16u
#define LR_PACKED_MAX_ENTRY_BITS 12u

// A block's kind.
#define LR_PACKED_KIND_BITS 2u
#define LR_PACKED_RECORD 0u  // a record of LR_PACKED_MAX_RECORD bytes or fewer
#define LR_PACKED_PARTED 1u  // LR_PACKED_PARTS records of so many triangles each, behind a byte with the length of each
#define LR_PACKED_PLAIN 2u   // three vertices a triangle as they are
#define LR_PACKED_MAX_RECORD 160u
#define LR_PACKED_PARTS 4u
#define LR_PACKED_MAX_PART 200u
#define LR_PACKED_PART 64u  // triangles of a part

// Event codes: so many ones before the zero. The last code has no zero. What another one changes:
// docs/packed-format.md, "Changing the format".
#define LR_PACKED_EVENT_CODES 7u
#define LR_PACKED_SPLIT 0u   // at its triangle: a T0; the polygon's smaller part comes next
#define LR_PACKED_BESIDE 1u  // before its triangle: a corridor that begins where the one before began or ended
#define LR_PACKED_START 2u   // before its triangle: another corridor
#define LR_PACKED_FAR 3u     // at its triangle: any third vertex
#define LR_PACKED_JUMP \
    4u  // at its triangle: a third vertex on the chain, and no corridor up to it, or of so many triangles
#define LR_PACKED_TURN 5u  // before its triangle: the orientation changes
#define LR_PACKED_FLIPS \
    6u  // before its triangle: a bit for each of the record's triangles, whether it is the other way round

// What a corridor's start says, after its code: so many ones before the zero.
#define LR_PACKED_START_OTHER 0u  // the other side of the polygon begun last
#define LR_PACKED_START_NEXT 1u   // the left side of the polygon behind it
#define LR_PACKED_START_NEAR 2u   // a polygon that begins a small offset behind that one
#define LR_PACKED_START_ANY 3u    // any

// Which vertex the next field is counted from, where a corridor begins beside another.
#define LR_PACKED_BESIDE_NOW_B 0u    // a, from the b where that one ended
#define LR_PACKED_BESIDE_NOW_A 1u    // b, from the a where it ended
#define LR_PACKED_BESIDE_BEGUN_A 2u  // a, from the a where it began
#define LR_PACKED_BESIDE_BEGUN_B 3u  // b, from the b where it began

// Orders of the Exp-Golomb codes.
#define LR_PACKED_JUMP_ORDER 1u
#define LR_PACKED_SIZE_ORDER 2u
#define LR_PACKED_BESIDE_ORDER 1u
#define LR_PACKED_FAR_ORDER 2u

#endif
