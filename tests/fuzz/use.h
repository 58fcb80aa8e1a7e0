#pragma once
// Uses what the library accepted, and aborts where it breaks a promise of its headers.

#include <cstdint>
#include <span>
#include <string>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/operators.hpp"
#include "lacedring/seams.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

/// One line of printable ASCII, not empty and not long.
void check_message(const Error& error);

/// Checks the invariant of Mesh (mesh.hpp).
void check_mesh(const Mesh& mesh);

/// Do both have the same attributes, byte by byte?
bool same_attributes(const Mesh& a, const Mesh& b);

/// Writes a small mesh in memory in each format, reads it back and compares; does nothing with a large one.
void check_writers(const Mesh& mesh);

// Decode a valid stream in every way that there is, compare the results with each other, check every reference, and
// call every operator on every corner and vertex. Return the triangles decoded, degenerate slots left out.
std::vector<std::uint32_t> use_lean(const LeanView& view);
std::vector<std::uint32_t> use_packed(const PackedView& view);
std::vector<std::uint32_t> use_lr(const LrStreamView<LrView>& stream);
std::vector<std::uint32_t> use_lr(const LrStreamView<CompactLrView>& stream);

/// Decodes a valid vertex stream as a whole and by blocks, and encodes the values again, losslessly. Does nothing with
/// one of more than 64 MiB: a few bytes may hold many equal vertices.
void use_vertices(const VertexView& view);

/// Decodes a section that is valid for the triangles as a whole and by blocks, and encodes some sections' copies again.
/// Does nothing with more than 2^16 vertices: a few bytes may hold many.
void use_seams(const SeamView& view, std::span<const std::uint32_t> triangles);

/// Calls every operator of a structure (Operators or one of its rivals) on every corner and vertex.
template <class Operators>
void check_operators(const Operators& ops, std::uint32_t triangle_numbers, std::uint32_t vertices) {
    const auto is_corner = [&](CornerId c) {
        return ops.triangle(c).value < triangle_numbers && ops.is_canonical(ops.triangle(c));
    };
    std::size_t corners = 0;
    for (std::uint32_t t = 0; t < triangle_numbers; ++t) {
        CornerId c = ops.corner(TriangleId{t});
        if (!ops.is_canonical(TriangleId{t})) {
            // A laced ring's redundant copy of a triangle, or its border: any other structure may not be asked.
            if constexpr (requires { ops.is_t0(c); }) {
                for (std::uint32_t k = 0; k < 3; ++k, c = ops.next(c)) {
                    const CornerId canonical = ops.canonical(c);
                    REQUIRE(canonical.is_null() ? ops.opposite(c).is_null() : is_corner(canonical));
                    if (canonical.is_null()) continue;
                    REQUIRE(ops.vertex(c) == ops.vertex(canonical));
                    REQUIRE(ops.opposite(c) == ops.opposite(canonical));
                }
            }
            continue;
        }
        corners += 3;
        for (std::uint32_t k = 0; k < 3; ++k, c = ops.next(c)) {
            REQUIRE(ops.triangle(c).value == t);
            REQUIRE(ops.canonical(c) == c);
            REQUIRE(ops.previous(ops.next(c)) == c);
            REQUIRE(ops.vertex(c).value < vertices);
            REQUIRE(ops.vertex(c) != ops.vertex(ops.next(c)));
            REQUIRE(ops.left(c) == ops.opposite(ops.next(c)));
            REQUIRE(ops.right(c) == ops.opposite(ops.previous(c)));
            if (const CornerId o = ops.opposite(c); !o.is_null()) {
                REQUIRE(is_corner(o));
                REQUIRE(ops.opposite(o) == c);
                REQUIRE(ops.vertex(ops.next(o)) == ops.vertex(ops.previous(c)));
                REQUIRE(ops.vertex(ops.previous(o)) == ops.vertex(ops.next(c)));
            }
            if (const CornerId s = ops.swing(c); !s.is_null()) {
                REQUIRE(is_corner(s));
                REQUIRE(ops.vertex(s) == ops.vertex(c));
                REQUIRE(ops.swing_back(s) == c);
            }
            if (const CornerId s = ops.swing_back(c); !s.is_null()) {
                REQUIRE(is_corner(s));
                REQUIRE(ops.swing(s) == c);
            }
        }
    }
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const CornerId first = ops.corner(VertexId{v});
        std::size_t star = 0, neighbours = 0;
        ops.star(VertexId{v}, [&](CornerId c) {
            REQUIRE(is_corner(c));
            REQUIRE(ops.vertex(c).value == v);
            REQUIRE(++star <= corners);
        });
        ops.neighbors(VertexId{v}, [&](VertexId u) {
            REQUIRE(u.value < vertices && u.value != v);
            REQUIRE(++neighbours <= 2 * corners);
        });
        REQUIRE(ops.valence(VertexId{v}) == neighbours);
        if (first.is_null()) {
            REQUIRE(star == 0 && neighbours == 0);
            continue;
        }
        REQUIRE(is_corner(first));
        REQUIRE(ops.vertex(first).value == v);
        REQUIRE(neighbours == star + (ops.is_border(VertexId{v}) ? 1 : 0));
    }
}

}  // namespace lacedring::fuzz
