#include "lacedring/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <unordered_map>

#include "lrcore/base/bits.h"
#include "lrcore/base/vec3.h"
#include "lrio/mesh/distinct.h"

namespace lacedring {
namespace {

/// The position of v, with 0 for -0.
Point position(const Positions& positions, std::uint32_t v) {
    Point p = positions[VertexId{v}];
    for (double& x : p) x += 0.0;
    return p;
}

double distance(const Point& a, const Point& b) {
    return detail::length(detail::minus(a, b));
}

/// Marks the vertices of triangles that are not degenerate.
BitVector used_vertices(const Mesh& mesh) {
    BitVector used(mesh.vertex_count);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* t = &mesh.indices[i];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (std::size_t j = 0; j < 3; ++j) used.set(t[j]);
    }
    return used;
}

/// The kept points in a grid. Its cell size is the tolerance, so that a cell has few points.
class Kept {
  public:
    explicit Kept(double tolerance) : tolerance_(tolerance) {}

    /// Returns the number of the nearest kept point within the tolerance; if there is none, keeps p and returns
    /// `number`.
    std::uint32_t join(const Point& p, std::uint32_t number) {
        const Point cell = cell_of(p);
        std::uint32_t nearest = number;
        double least = tolerance_;
        for (int n = 0; n < 27; ++n) {
            const auto found = cells_.find(key({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1}));
            if (found == cells_.end()) continue;
            for (std::uint32_t i = found->second; i != kNone; i = points_[i].next) {
                const double d = distance(points_[i].at, p);
                if (d > least || (d == least && nearest < points_[i].number)) continue;
                least = d;
                nearest = points_[i].number;
            }
        }
        if (nearest != number) return nearest;
        const auto [first, is_new] = cells_.try_emplace(key(cell), kNone);
        points_.push_back({p, number, first->second});
        first->second = static_cast<std::uint32_t>(points_.size() - 1);
        return number;
    }

  private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    struct Entry {
        Point at;
        std::uint32_t number, next;
    };

    /// The cell of a point. Where the grid is finer than the spacing of doubles, a coordinate is its own cell, since
    /// the quotient may be infinite.
    Point cell_of(Point p) const {
        constexpr double kNarrow = 9007199254740992.0;  // 2^53
        for (double& x : p) {
            const double cell = std::floor(x / tolerance_);
            if (std::abs(cell) < kNarrow) x = cell;
        }
        return p;
    }
    /// Two cells may have the same key, so join() compares the distances of the points.
    static std::uint64_t key(Point cell) {
        for (double& x : cell) x += 0.0;
        return detail::hash_bytes(reinterpret_cast<const std::byte*>(cell.data()), sizeof cell, 0);
    }

    double tolerance_;
    std::unordered_map<std::uint64_t, std::uint32_t> cells_;  // index in points_ of each cell's last point
    std::vector<Entry> points_;
};

/// The group of each vertex, named by the group's first vertex. Each unused vertex is its own group.
struct VertexGroups {
    std::vector<std::uint32_t> equal;  ///< groups of equal position
    std::vector<std::uint32_t> near;   ///< groups of the same kept vertex; empty without a tolerance
};

VertexGroups group_vertices(const Mesh& mesh, const Positions& positions, double tolerance) {
    const BitVector used = used_vertices(mesh);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        if (used.test(v)) vertices.push_back(v);
    }
    const detail::Groups groups = detail::group_equal(
        static_cast<std::uint32_t>(vertices.size()),
        [&](std::uint32_t i) {
            const Point p = position(positions, vertices[i]);
            return detail::hash_bytes(reinterpret_cast<const std::byte*>(p.data()), sizeof p, 0);
        },
        [&](std::uint32_t i, std::uint32_t j) {
            const Point p = position(positions, vertices[i]), q = position(positions, vertices[j]);
            return std::memcmp(p.data(), q.data(), sizeof p);
        });
    const auto by_first = [&](std::span<const std::uint32_t> first) {
        std::vector<std::uint32_t> out(mesh.vertex_count);
        std::iota(out.begin(), out.end(), 0U);
        for (std::size_t i = 0; i < vertices.size(); ++i) out[vertices[i]] = first[groups.of[i]];
        return out;
    };
    std::vector<std::uint32_t> first = groups.first_items();
    for (std::uint32_t& item : first) item = vertices[item];
    VertexGroups out{by_first(first), {}};
    if (!(tolerance > 0)) return out;
    Kept kept(tolerance);
    for (std::uint32_t& v : first) v = kept.join(position(positions, v), v);
    out.near = by_first(first);
    return out;
}

/// The pairs of vertices that are in the same group and triangle, the greater vertex first, sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_in_triangles(const Mesh& mesh,
                                                                        std::span<const std::uint32_t> group) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* t = &mesh.indices[i];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::uint32_t a = t[j], b = t[(j + 1) % 3];
            if (group[a] == group[b]) out.emplace_back(std::max(a, b), std::min(a, b));
        }
    }
    std::ranges::sort(out);
    return out;
}

/// Makes each -0 of `to` a 0 if `from` has 0 there.
template <class Real>
void keep_zeros(std::byte* to, const std::byte* from) {
    for (std::size_t at = 0; at < 3 * sizeof(Real); at += sizeof(Real)) {
        Real a = 0, b = 0;
        std::memcpy(&a, to + at, sizeof a);
        std::memcpy(&b, from + at, sizeof b);
        if (a == 0 && b == 0 && !std::signbit(b)) std::memcpy(to + at, &b, sizeof b);
    }
}

/// The positions of the surface's vertices: those of their first copies, but 0 for -0 if another copy has 0.
Attribute surface_positions(const Attribute& positions, const Surface& surface) {
    Attribute out = std::move(permute_attributes({&positions, 1}, first_vertices(surface))[0]);
    const std::size_t stride = positions.stride();
    const bool wide = positions.type == ComponentType::f64;
    if (positions.components != 3 || (!wide && positions.type != ComponentType::f32)) return out;
    for (std::size_t v = 0; v < surface.vertex_of.size(); ++v) {
        std::byte* to = out.data.data() + surface.vertex_of[v] * stride;
        const std::byte* from = positions.data.data() + v * stride;
        if (std::memcmp(to, from, stride) != 0) wide ? keep_zeros<double>(to, from) : keep_zeros<float>(to, from);
    }
    return out;
}

/// Counts the vertices that joining moves.
SurfaceReport report_moves(const Mesh& mesh, const Surface& surface) {
    SurfaceReport out;
    const Attribute &before = *find_attribute(mesh, "POSITION"), after = surface_positions(before, surface);
    const bool wide = before.type == ComponentType::f64;
    const Positions from{before.data, wide}, there{after.data, wide};
    const std::size_t stride = before.stride();
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const std::uint32_t to = surface.vertex_of[v];
        if (std::memcmp(before.data.data() + v * stride, after.data.data() + to * stride, stride) == 0) continue;
        ++out.moved;
        out.largest_move = std::max(out.largest_move, distance(position(from, v), position(there, to)));
    }
    return out;
}

}  // namespace

Surface find_surface(const Mesh& mesh, double tolerance, SurfaceReport* report) {
    if (report != nullptr) *report = {};
    Surface out;
    out.vertex_count = mesh.vertex_count;
    const Positions positions = positions_of(mesh);
    if (positions.empty()) return out;
    const VertexGroups groups = group_vertices(mesh, positions, tolerance);
    const std::vector<std::uint32_t>& group = groups.near.empty() ? groups.equal : groups.near;
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> apart = pairs_in_triangles(mesh, group);
    // Vertices of one triangle get different ranks in their group. Vertices of rank 0 of a group are joined. Vertices
    // of a higher rank are joined only if their positions are equal, since they may be twice the tolerance apart.
    std::vector<std::uint32_t> rank(apart.empty() ? 0 : mesh.vertex_count), ranks_apart;
    // The surface vertex of rank 0 of the group with this first vertex.
    std::vector<std::uint32_t> number(mesh.vertex_count, UINT32_MAX);
    // The surface vertex of a position and a rank above 0.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> higher;
    std::vector<std::uint32_t> vertex_of(mesh.vertex_count);
    std::uint32_t count = 0;
    auto pair = apart.begin();
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        ranks_apart.clear();
        for (; pair != apart.end() && pair->first == v; ++pair) ranks_apart.push_back(rank[pair->second]);
        std::ranges::sort(ranks_apart);
        std::uint32_t own = 0;
        for (const std::uint32_t other : ranks_apart) own += own == other ? 1 : 0;
        if (!rank.empty()) rank[v] = own;
        std::uint32_t& joined =
            own == 0 ? number[group[v]] : higher.try_emplace({groups.equal[v], own}, UINT32_MAX).first->second;
        if (joined == UINT32_MAX) joined = count++;
        vertex_of[v] = joined;
    }
    if (count == mesh.vertex_count) return out;
    out.vertex_count = count;
    out.vertex_of = std::move(vertex_of);
    if (report != nullptr) *report = report_moves(mesh, out);
    return out;
}

std::vector<std::uint32_t> first_vertices(const Surface& surface) {
    std::vector<std::uint32_t> out(surface.vertex_count, UINT32_MAX);
    if (!surface.has_seams()) std::iota(out.begin(), out.end(), 0U);
    for (std::uint32_t v = 0; v < surface.vertex_of.size(); ++v) {
        std::uint32_t& first = out[surface.vertex_of[v]];
        first = std::min(first, v);
    }
    return out;
}

std::vector<CornerId> seam_edges(const CornerTable& table, const Mesh& mesh) {
    const auto vertex = [&](CornerId c) {
        const std::uint32_t t = c.value / 3, place = c.value % 3;
        return mesh.indices[3 * t + (place > 0 && table.flipped(TriangleId{t}) ? 3 - place : place)];
    };
    std::vector<CornerId> out;
    for (std::uint32_t i = 0; i < table.corners.size(); ++i) {
        const CornerId c{i}, o = table.opposite(c);
        if (o.is_null() || o < c) continue;
        if (vertex(next(c)) != vertex(previous(o)) || vertex(previous(c)) != vertex(next(o))) out.push_back(c);
    }
    return out;
}

void move_to_surface(Mesh& mesh, const Surface& surface) {
    if (!surface.has_seams()) return;
    for (Attribute& attribute : mesh.attributes) {
        if (attribute.name != "POSITION") continue;
        const Attribute joined = surface_positions(attribute, surface);
        attribute = std::move(permute_attributes({&joined, 1}, surface.vertex_of)[0]);
    }
}

Mesh merge_copies(const Mesh& mesh, Surface& surface) {
    if (!surface.has_seams()) return mesh;
    const detail::Groups groups = detail::group_equal(
        mesh.vertex_count,
        [&](std::uint32_t v) {
            std::uint64_t hash = surface.vertex_of[v];
            for (const Attribute& a : mesh.attributes) {
                if (a.name != "POSITION") hash = detail::hash_bytes(a.data.data() + v * a.stride(), a.stride(), hash);
            }
            return detail::mix(hash, 0);
        },
        [&](std::uint32_t v, std::uint32_t w) {
            if (surface.vertex_of[v] != surface.vertex_of[w])
                return surface.vertex_of[v] < surface.vertex_of[w] ? -1 : 1;
            for (const Attribute& a : mesh.attributes) {
                if (a.name == "POSITION") continue;
                const std::size_t stride = a.stride();
                const int order = std::memcmp(a.data.data() + v * stride, a.data.data() + w * stride, stride);
                if (order != 0) return order;
            }
            return 0;
        });
    if (groups.count == mesh.vertex_count) return mesh;
    const std::vector<std::uint32_t> kept = groups.first_items();
    Mesh out;
    out.vertex_count = groups.count;
    out.attributes = permute_attributes(mesh.attributes, kept);
    out.indices.reserve(mesh.indices.size());
    for (const std::uint32_t v : mesh.indices) out.indices.push_back(groups.of[v]);
    std::vector<std::uint32_t> vertex_of;
    if (groups.count > surface.vertex_count) {
        for (const std::uint32_t v : kept) vertex_of.push_back(surface.vertex_of[v]);
    }
    surface.vertex_of = std::move(vertex_of);
    return out;
}

Mesh surface_mesh(const Mesh& mesh, const Surface& surface) {
    Mesh out;
    out.vertex_count = surface.vertex_count;
    out.indices = mesh.indices;
    if (surface.has_seams()) {
        for (std::uint32_t& v : out.indices) v = surface.vertex_of[v];
    }
    if (const Attribute* positions = find_attribute(mesh, "POSITION")) {
        out.attributes.push_back(surface_positions(*positions, surface));
    }
    return out;
}

}  // namespace lacedring
