// The blob, a bumpy closed surface with irregular valences like a scan: a sphere with many edges flipped.

#include <cmath>
#include <cstring>
#include <vector>

#include "lrlab/generate/detail.h"

namespace lacedring::detail {
namespace {

constexpr std::uint32_t next(std::uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}
constexpr std::uint32_t previous(std::uint32_t c) {
    return c % 3 == 0 ? c + 2 : c - 1;
}

Point read(const std::vector<std::byte>& positions, std::size_t v) {
    float xyz[3];
    std::memcpy(xyz, positions.data() + v * sizeof xyz, sizeof xyz);
    return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1]), static_cast<double>(xyz[2])};
}

void write(std::vector<std::byte>& positions, std::size_t v, Point p) {
    const float xyz[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    std::memcpy(positions.data() + v * sizeof xyz, xyz, sizeof xyz);
}

/// Six times the volume of the tetrahedron with the origin: positive if the triangle faces outwards.
double volume(Point a, Point b, Point c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The opposite corners of a closed manifold. head[v] begins a short list of the unmatched corners whose next vertex is
/// v: one for each half-edge that starts at v.
std::vector<std::uint32_t> opposites(const std::vector<std::uint32_t>& V, std::uint32_t vertex_count) {
    const auto corners = static_cast<std::uint32_t>(V.size());
    std::vector<std::uint32_t> O(corners, UINT32_MAX);
    std::vector<std::uint32_t> head(vertex_count, UINT32_MAX);
    // While a corner has no opposite yet, its entry of O is the link to the next corner of its list.
    for (std::uint32_t c = 0; c < corners; ++c) {
        const std::uint32_t from = V[next(c)];
        const std::uint32_t to = V[previous(c)];
        std::uint32_t* link = &head[to];
        while (*link != UINT32_MAX && V[previous(*link)] != from) link = &O[*link];
        if (*link != UINT32_MAX) {
            const std::uint32_t other = *link;
            *link = O[other];
            O[c] = other;
            O[other] = c;
        } else {
            O[c] = head[from];
            head[from] = c;
        }
    }
    return O;
}

class Flipper {
  public:
    Flipper(Mesh& mesh, const std::vector<std::byte>& positions)
        : V_(mesh.indices),
          O_(opposites(V_, mesh.vertex_count)),
          positions_(positions),
          valence_(mesh.vertex_count, 0) {
        for (const std::uint32_t v : V_) ++valence_[v];
    }

    /// Flips the edge opposite to about every fifteenth corner. Visiting corners in order keeps the triangles' order
    /// local. About 35 % of the valences stay 6, slightly fewer than in most scans.
    void sweep(Random& random) {
        for (std::uint32_t c = 0; c < V_.size(); ++c) {
            if (random.below(15) == 0) flip(c);
        }
    }

  private:
    /// Replaces the edge ab between the triangles cab and dba by cd. Does nothing if the mesh already has the edge cd,
    /// a valence would leave 3..12, or a triangle would become thin or flip over.
    void flip(std::uint32_t corner) {
        const std::uint32_t c0 = corner;
        const std::uint32_t c1 = next(c0);
        const std::uint32_t c2 = previous(c0);
        const std::uint32_t d0 = O_[c0];
        const std::uint32_t d1 = next(d0);
        const std::uint32_t d2 = previous(d0);
        const std::uint32_t a = V_[c1];
        const std::uint32_t b = V_[c2];
        const std::uint32_t c = V_[c0];
        const std::uint32_t d = V_[d0];
        if (c == d || valence_[a] <= 3 || valence_[b] <= 3 || valence_[c] >= 12 || valence_[d] >= 12) return;
        const Point pa = read(positions_, a);
        const Point pb = read(positions_, b);
        const Point pc = read(positions_, c);
        const Point pd = read(positions_, d);
        const double before = volume(pc, pa, pb) + volume(pd, pb, pa);
        if (volume(pc, pa, pd) < 0.2 * before || volume(pd, pb, pc) < 0.2 * before) return;
        if (adjacent(c0, d)) return;
        // cab, dba become cad, dbc. The neighbors across bc and ad get other opposite corners.
        const std::uint32_t across_bc = O_[c1];
        const std::uint32_t across_ad = O_[d1];
        V_[c2] = d;
        V_[d2] = c;
        join(c0, across_ad);
        join(d0, across_bc);
        join(c1, d1);
        --valence_[a];
        --valence_[b];
        ++valence_[c];
        ++valence_[d];
    }

    void join(std::uint32_t c, std::uint32_t o) {
        O_[c] = o;
        O_[o] = c;
    }

    /// Is there an edge from the vertex of `corner` to v?
    bool adjacent(std::uint32_t corner, std::uint32_t v) const {
        std::uint32_t c = corner;
        do {
            if (V_[next(c)] == v) return true;
            c = next(O_[next(c)]);
        } while (c != corner);
        return false;
    }

    std::vector<std::uint32_t>& V_;
    std::vector<std::uint32_t> O_;
    const std::vector<std::byte>& positions_;
    std::vector<std::uint8_t> valence_;
};

}  // namespace

Result<Mesh> make_blob(std::uint64_t triangles, std::uint64_t seed) {
    const SphereShape shape = sphere_shape(triangles);
    if (shape.vertices() > kMostVertices) return too_many_generated();
    Mesh mesh = build_sphere(shape).finish();
    std::vector<std::byte>& positions = mesh.attributes[0].data;
    Random random(seed);
    // Moves vertices on the sphere by up to a fifth of an edge, so that the possible flips vary from place to place.
    const double reach = 0.6 / static_cast<double>(shape.rows());
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        Point p = read(positions, v);
        p[0] += reach * random.signed_unit();
        p[1] += reach * random.signed_unit();
        p[2] += reach * random.signed_unit();
        const double size = length(p);
        write(positions, v, {p[0] / size, p[1] / size, p[2] / size});
    }
    {
        Flipper flipper(mesh, positions);
        flipper.sweep(random);
    }
    const std::uint64_t bumps = random.next();
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const Point p = read(positions, v);
        const double radius = 1 + 0.35 * fractal_noise({1.3 * p[0], 1.3 * p[1], 1.3 * p[2]}, 6, bumps);
        write(positions, v, {radius * p[0], radius * p[1], radius * p[2]});
    }
    return mesh;
}

}  // namespace lacedring::detail
