/* What the decoders take of math.h: an instruction. */
#ifndef LACEDRING_WASM_MATH_H
#define LACEDRING_WASM_MATH_H
#define sqrt __builtin_sqrt
#endif
