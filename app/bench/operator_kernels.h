#pragma once
// Work that is timed on every structure with corner operators.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "lacedring/base.hpp"
#include "lrlab/rivals/squad.h"

namespace lacedring::app {

/// c.o; for SQuad c.s, which is the operator that it stores.
template <class Ops>
CornerId step_of(const Ops& ops, CornerId c) {
    if constexpr (std::is_same_v<Ops, SquadView>) {
        return ops.swing(c);
    } else {
        return ops.opposite(c);
    }
}

/// The z of the sum of cross products around v; on a border the gap counts as a triangle. Returns 0 for values near 0,
/// whose sign would depend on rounding, and so on where the star begins.
template <class Ops>
float normal_z(const Ops& ops, const std::vector<float>& positions, VertexId v) {
    const float* p = positions.data() + 3 * std::size_t{v.value};
    float first[2] = {0, 0}, last[2] = {0, 0}, z = 0, size = 0;
    bool any = false;
    const auto add = [&](const float* a, const float* b) {
        const float x = a[0] * b[1], y = a[1] * b[0];
        z += x - y;
        size += std::abs(x) + std::abs(y);
    };
    ops.neighbors(v, [&](VertexId u) {
        const float* q = positions.data() + 3 * std::size_t{u.value};
        const float d[2] = {q[0] - p[0], q[1] - p[1]};
        if (any) {
            add(last, d);
        } else {
            std::copy_n(d, 2, first);
            any = true;
        }
        std::copy_n(d, 2, last);
    });
    add(last, first);
    return std::abs(z) > 1e-5F * size ? z : 0;
}

}  // namespace lacedring::app
