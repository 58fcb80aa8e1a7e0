/* The part of math.h that the decoders use: sqrt, an instruction of WebAssembly. */
#ifndef LACEDRING_WASM_MATH_H
#define LACEDRING_WASM_MATH_H
#define sqrt __builtin_sqrt
#endif
