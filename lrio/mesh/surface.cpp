#include "lacedring/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <unordered_map>

#include "lrcore/base/bits.h"
#include "lrio/mesh/distinct.h"

namespace lacedring {
namespace {

/// -0 is 0.
Point position(const Positions& positions, std::uint32_t v) {
    Point p = positions[VertexId{v}];
    for (double& x : p) x += 0.0;
    return p;
}

double distance(const Point& a, const Point& b) {
    return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
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

/// Points that were kept, by the cells of a grid whose side is the tolerance: few fit into one.
class Kept {
  public:
    explicit Kept(double tolerance) : tolerance_(tolerance) {}

    /// The nearest kept point within the tolerance, or this one, which is kept then.
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

    Point cell_of(const Point& p) const {
        return {std::floor(p[0] / tolerance_), std::floor(p[1] / tolerance_), std::floor(p[2] / tolerance_)};
    }
    /// Two cells may have one key: points are compared themselves.
    static std::uint64_t key(Point cell) {
        for (double& x : cell) x += 0.0;
        return detail::hash_bytes(reinterpret_cast<const std::byte*>(cell.data()), sizeof cell, 0);
    }

    double tolerance_;
    std::unordered_map<std::uint64_t, std::uint32_t> cells_;  // the last point of each
    std::vector<Entry> points_;
};

/// The group of each vertex, named by its first one. Vertices that are not used are alone.
std::vector<std::uint32_t> group_vertices(const Mesh& mesh, const Positions& positions, double tolerance) {
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
    std::vector<std::uint32_t> first = groups.first_items(), out(mesh.vertex_count);
    for (std::uint32_t& item : first) item = vertices[item];
    if (tolerance > 0) {
        Kept kept(tolerance);
        for (std::uint32_t& v : first) v = kept.join(position(positions, v), v);
    }
    std::iota(out.begin(), out.end(), 0U);
    for (std::size_t i = 0; i < vertices.size(); ++i) out[vertices[i]] = first[groups.of[i]];
    return out;
}

/// Two vertices of one group and one triangle, the greater one first, in increasing order.
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

}  // namespace

Surface find_surface(const Mesh& mesh, double tolerance, SurfaceReport* report) {
    Surface out;
    out.vertex_count = mesh.vertex_count;
    const Positions positions = positions_of(mesh);
    if (positions.empty()) return out;
    const std::vector<std::uint32_t> group = group_vertices(mesh, positions, tolerance);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> apart = pairs_in_triangles(mesh, group);
    // Of a group, vertices of rank 0 are joined, those of rank 1, and so on.
    std::vector<std::uint32_t> rank(apart.empty() ? 0 : mesh.vertex_count), ranks_apart;
    std::vector<std::uint32_t> number(mesh.vertex_count, UINT32_MAX);  // of rank 0 of the group with that first vertex
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> higher;  // of a group and a rank
    std::vector<std::uint32_t> vertex_of(mesh.vertex_count), first;
    auto pair = apart.begin();
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        ranks_apart.clear();
        for (; pair != apart.end() && pair->first == v; ++pair) ranks_apart.push_back(rank[pair->second]);
        std::ranges::sort(ranks_apart);
        std::uint32_t own = 0;
        for (const std::uint32_t other : ranks_apart) own += own == other ? 1 : 0;
        if (!rank.empty()) rank[v] = own;
        std::uint32_t& joined =
            own == 0 ? number[group[v]] : higher.try_emplace({group[v], own}, UINT32_MAX).first->second;
        if (joined == UINT32_MAX) {
            joined = static_cast<std::uint32_t>(first.size());
            first.push_back(v);
        }
        vertex_of[v] = joined;
    }
    if (report != nullptr) {
        const Attribute& position_attribute = *find_attribute(mesh, "POSITION");
        const std::size_t stride = position_attribute.stride();
        const std::byte* bytes = position_attribute.data.data();
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
            const std::uint32_t to = first[vertex_of[v]];
            if (std::memcmp(bytes + v * stride, bytes + to * stride, stride) == 0) continue;
            ++report->moved;
            report->largest_move =
                std::max(report->largest_move, distance(position(positions, v), position(positions, to)));
        }
    }
    if (first.size() == mesh.vertex_count) return out;
    out.vertex_count = static_cast<std::uint32_t>(first.size());
    out.vertex_of = std::move(vertex_of);
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
    const std::vector<std::uint32_t> first = first_vertices(surface);
    for (Attribute& attribute : mesh.attributes) {
        if (attribute.name != "POSITION") continue;
        const std::size_t stride = attribute.stride();
        for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
            const std::size_t from = first[surface.vertex_of[v]];  // v or one before it, which does not move
            std::memmove(attribute.data.data() + v * stride, attribute.data.data() + from * stride, stride);
        }
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
        out.attributes = permute_attributes(std::span(positions, 1), first_vertices(surface));
    }
    return out;
}

}  // namespace lacedring
