/* The part of string.h that the decoders use: the compiler turns these into instructions. */
#ifndef LACEDRING_WASM_STRING_H
#define LACEDRING_WASM_STRING_H
#include <stddef.h>
#define memcpy __builtin_memcpy
#define memmove __builtin_memmove
#define memset __builtin_memset
#endif
