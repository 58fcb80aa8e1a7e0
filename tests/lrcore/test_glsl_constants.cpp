// Checks that the constants in shaders/include/lacedring.glsl, which repeats them to be usable alone, equal those of
// the library: a macro defined twice with different values does not compile (CMakeLists.txt sets -Werror for this
// file).
#include "lrcore/codec/lean/lean_format.h"
#include "lrcore/codec/packed/packed_format.h"
#include "shaders/include/lacedring.glsl"

#ifndef LACEDRING_GLSL
#error "shaders/include/lacedring.glsl was not read"
#endif
