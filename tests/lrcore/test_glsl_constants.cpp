// shaders/include/lacedring.glsl repeats the constants of the formats, so that it can be taken alone. One that differs
// is a macro defined twice, which does not compile (-Werror on this file, in tests/lrcore/CMakeLists.txt, whatever the
// build).
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_format.h"
#include "shaders/include/lacedring.glsl"

#ifndef LACEDRING_GLSL
#error "shaders/include/lacedring.glsl was not read"
#endif
