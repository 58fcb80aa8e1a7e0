#pragma once
// Uses data that the library accepted, and aborts if the library breaks a promise of its headers.

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

/// Checks that the message is a short line of printable ASCII.
void check_message(const Error& error);

/// Checks the invariant of Mesh (mesh.hpp).
void check_mesh(const Mesh& mesh);

/// Returns whether both meshes have the same attributes, byte by byte.
bool same_attributes(const Mesh& a, const Mesh& b);

/// Writes a small mesh to memory in each format, reads it and compares. Ignores large meshes.
void check_writers(const Mesh& mesh);

// The functions use_... decode a valid stream in every way, compare the results, check every reference, and call every
// operator on every corner and vertex. They return the decoded triangles without degenerate slots.
std::vector<std::uint32_t> use_lean(const LeanView& view);
std::vector<std::uint32_t> use_packed(const PackedView& view);
std::vector<std::uint32_t> use_lr(const LrStreamView<LrView>& stream);
std::vector<std::uint32_t> use_lr(const LrStreamView<CompactLrView>& stream);

/// Decodes a valid vertex stream as a whole and by blocks, and encodes the values again without loss. Ignores streams
/// that decode to more than 64 MiB, which a few bytes can do.
void use_vertices(const VertexView& view);

/// Decodes a seam section that is valid for the triangles, as a whole and by blocks, and encodes the copies of some
/// sections again. Ignores sections of more than 2^16 vertices, which a few bytes can hold.
void use_seams(const SeamView& view, std::span<const std::uint32_t> triangles);

/// Calls every operator of a structure (Operators or one of its rivals) on every corner and vertex.
template <class Operators>
class OperatorUser {
  public:
    OperatorUser(const Operators& ops, std::uint32_t triangle_numbers, std::uint32_t vertices)
        : ops_(ops), triangle_numbers_(triangle_numbers), vertices_(vertices) {}

    void use_corners() {
        for (std::uint32_t t = 0; t < triangle_numbers_; ++t) {
            CornerId c = ops_.corner(TriangleId{t});
            const bool is_triangle = ops_.is_canonical(TriangleId{t});
            for (std::uint32_t k = 0; k < 3; ++k) {
                if (is_triangle) {
                    use_corner(c, t);
                } else if constexpr (requires { ops_.is_t0(c); }) {
                    use_redundant_corner(c);
                } else {
                    break;
                }
                c = ops_.next(c);
            }
            if (is_triangle) corners_ += 3;
        }
    }

    void use_vertex(std::uint32_t v) {
        const CornerId first = ops_.corner(VertexId{v});
        std::size_t star = 0, neighbors = 0;
        ops_.star(VertexId{v}, [&](CornerId c) {
            REQUIRE(is_corner(c));
            REQUIRE(ops_.vertex(c).value == v);
            REQUIRE(++star <= corners_);
        });
        ops_.neighbors(VertexId{v}, [&](VertexId u) {
            REQUIRE(u.value < vertices_ && u.value != v);
            REQUIRE(++neighbors <= 2 * corners_);
        });
        REQUIRE(ops_.valence(VertexId{v}) == neighbors);
        if (first.is_null()) {
            REQUIRE(star == 0 && neighbors == 0);
            return;
        }
        REQUIRE(is_corner(first));
        REQUIRE(ops_.vertex(first).value == v);
        REQUIRE(neighbors == star + (ops_.is_border(VertexId{v}) ? 1 : 0));
    }

  private:
    bool is_corner(CornerId c) const {
        return ops_.triangle(c).value < triangle_numbers_ && ops_.is_canonical(ops_.triangle(c));
    }

    /// A corner of a T2's second copy or of a border slot. Only the LR tables have these; other structures need not
    /// answer.
    void use_redundant_corner(CornerId c) const {
        const CornerId canonical = ops_.canonical(c);
        REQUIRE(canonical.is_null() ? ops_.opposite(c).is_null() : is_corner(canonical));
        if (canonical.is_null()) return;
        REQUIRE(ops_.vertex(c) == ops_.vertex(canonical));
        REQUIRE(ops_.opposite(c) == ops_.opposite(canonical));
    }

    void use_corner(CornerId c, std::uint32_t t) const {
        REQUIRE(ops_.triangle(c).value == t);
        REQUIRE(ops_.canonical(c) == c);
        REQUIRE(ops_.previous(ops_.next(c)) == c);
        REQUIRE(ops_.vertex(c).value < vertices_);
        REQUIRE(ops_.vertex(c) != ops_.vertex(ops_.next(c)));
        REQUIRE(ops_.left(c) == ops_.opposite(ops_.next(c)));
        REQUIRE(ops_.right(c) == ops_.opposite(ops_.previous(c)));
        if (const CornerId o = ops_.opposite(c); !o.is_null()) {
            REQUIRE(is_corner(o));
            REQUIRE(ops_.opposite(o) == c);
            REQUIRE(ops_.vertex(ops_.next(o)) == ops_.vertex(ops_.previous(c)));
            REQUIRE(ops_.vertex(ops_.previous(o)) == ops_.vertex(ops_.next(c)));
        }
        if (const CornerId s = ops_.swing(c); !s.is_null()) {
            REQUIRE(is_corner(s));
            REQUIRE(ops_.vertex(s) == ops_.vertex(c));
            REQUIRE(ops_.swing_back(s) == c);
        }
        if (const CornerId s = ops_.swing_back(c); !s.is_null()) {
            REQUIRE(is_corner(s));
            REQUIRE(ops_.swing(s) == c);
        }
    }

    const Operators& ops_;
    std::uint32_t triangle_numbers_, vertices_;
    std::size_t corners_ = 0;  ///< of all triangles
};

template <class Operators>
void check_operators(const Operators& ops, std::uint32_t triangle_numbers, std::uint32_t vertices) {
    OperatorUser<Operators> user(ops, triangle_numbers, vertices);
    user.use_corners();
    for (std::uint32_t v = 0; v < vertices; ++v) user.use_vertex(v);
}

}  // namespace lacedring::fuzz
