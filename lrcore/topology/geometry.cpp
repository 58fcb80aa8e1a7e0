#include <bit>
#include <limits>
#include <utility>

#include "lacedring/topology.hpp"
#include "lrcore/base/bits.h"
#include "lrcore/base/vec3.h"

namespace lacedring {
namespace {

using detail::cross, detail::dot, detail::minus;

/// Neumaier's compensated sum: the error does not grow with the number of terms.
class Sum {
  public:
    void add(double x) {
        const double sum = sum_ + x;
        rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + rest_; }

  private:
    double sum_ = 0, rest_ = 0;
};

/// The volume between a point and triangles, as a sum of mixed products.
class MixedProducts {
  public:
    explicit MixedProducts(const Point& from) : from_(from) {}

    /// Uses mp(P,Q,R) = mp(P,Q-P,R-P): its factors are small, so less cancels.
    void add(const Point& p, const Point& q, const Point& r) {
        const Point a = minus(p, from_), e = minus(q, p), f = minus(r, p);
        const Point n = cross(e, f);
        sum_.add(dot(n, a));
        // The product of the absolute values: rounding errors are relative to it.
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            magnitude_ += (std::abs(e[i] * f[j]) + std::abs(e[j] * f[i])) * std::abs(a[k]);
        }
    }
    double volume() const { return sum_.value() / 6; }
    /// Each of a determinant's six terms takes three differences, two products and three sums: 8 roundings of half an
    /// epsilon. Twice that also covers the rounding of the sum.
    double error() const { return 8 * std::numeric_limits<double>::epsilon() * magnitude_ / 6; }

  private:
    Point from_;
    Sum sum_;
    double magnitude_ = 0;
};

}  // namespace

std::vector<float> vertex_normals(const CornerTable& table, const Positions& positions) {
    std::vector<double> sums(std::size_t{table.vertex_count} * 3, 0.0);
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        // The three corners of a triangle have the same cross product: computed once.
        const VertexId v[] = {table.vertex(corner(TriangleId{t}, 0)), table.vertex(corner(TriangleId{t}, 1)),
                              table.vertex(corner(TriangleId{t}, 2))};
        const Point a = positions[v[0]];
        const Point n = cross(minus(positions[v[1]], a), minus(positions[v[2]], a));
        for (const VertexId u : v) {
            for (std::size_t i = 0; i < 3; ++i) sums[std::size_t{u.value} * 3 + i] += n[i];
        }
    }
    std::vector<float> normals(sums.size());
    for (std::size_t v = 0; v < sums.size(); v += 3) {
        const double length = std::hypot(sums[v], sums[v + 1], sums[v + 2]);
        const bool none = !(length > 0) || !std::isfinite(length);
        for (std::size_t i = 0; i < 3; ++i) {
            normals[v + i] = none ? (i == 2 ? 1.0F : 0.0F) : static_cast<float>(sums[v + i] / length);
        }
    }
    return normals;
}

std::vector<ClosedShell> closed_shells(const CornerTable& table, const Positions& positions) {
    std::vector<ClosedShell> shells;
    Swirl swirl(table);
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (swirl.visited(TriangleId{t}) || table.degenerate(TriangleId{t})) continue;
        MixedProducts products(positions[table.vertex(corner(TriangleId{t}, 0))]);
        std::uint32_t triangles = 0;
        bool closed = true;
        swirl.run(corner(TriangleId{t}, 0), [&](CornerId c) {
            const CornerId n = next(c), p = previous(c);
            products.add(positions[table.vertex(c)], positions[table.vertex(n)], positions[table.vertex(p)]);
            ++triangles;
            closed =
                closed && !table.opposite(c).is_null() && !table.opposite(n).is_null() && !table.opposite(p).is_null();
        });
        if (closed) shells.push_back({TriangleId{t}, triangles, products.volume(), products.error()});
    }
    return shells;
}

std::uint32_t make_counterclockwise(CornerTable& table, const Positions& positions) {
    BitVector turned(table.triangle_count());
    std::uint32_t shells = 0;
    {
        Swirl swirl(table);
        for (const ClosedShell& shell : closed_shells(table, positions)) {
            if (!shell.inside_out()) continue;
            ++shells;
            swirl.run(corner(shell.first, 0), [&](CornerId c) { turned.set(triangle(c).value); });
        }
    }
    if (shells == 0) return 0;
    if (table.flip.empty()) table.flip.assign((std::size_t{table.triangle_count()} + 63) / 64, 0);
    // Swaps corners 1 and 2 of every triangle of the shell, and renumbers the opposites accordingly.
    constexpr std::uint32_t kMirrored[] = {0, 2, 1};
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        if (!turned.test(t)) continue;
        table.flip[t / 64] ^= std::uint64_t{1} << (t % 64);
        CornerTable::Corner* corners = &table.corners[std::size_t{t} * 3];
        std::swap(corners[1], corners[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            const CornerId o = corners[k].opposite;
            corners[k].opposite = corner(triangle(o), kMirrored[o.value % 3]);
        }
    }
    table.topology.flipped = 0;
    for (const std::uint64_t word : table.flip)
        table.topology.flipped += static_cast<std::uint32_t>(std::popcount(word));
    if (table.topology.flipped == 0) table.flip.clear();
    return shells;
}

}  // namespace lacedring
