#pragma once
// Shared helpers of the generators. Private to lrlab/generate.

#include <cstddef>
#include <cstdint>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lrcore/base/random.h"
#include "lrcore/base/vec3.h"

namespace lacedring::detail {

/// Largest number of vertices of a generated mesh: the lean stream's limit.
constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 29;

/// Random numbers; those of successive seeds are unrelated.
class Random : public SplitMix64 {
  public:
    explicit Random(std::uint64_t seed) : SplitMix64(SplitMix64(seed).next()) {}

    /// In [low, high].
    std::uint32_t between(std::uint32_t low, std::uint32_t high) { return low + below(std::uint64_t{high} - low + 1); }
    /// In [-1, 1), a multiple of 2^-23.
    double signed_unit() { return static_cast<double>(next() >> 40) * (1.0 / 8388608.0) - 1.0; }
};

using Point = Vec3<double>;

/// Cosine and sine of the angle k/n * 2 pi; n >= 1, k < 2^60. Exact at multiples of a quarter turn.
struct Turn {
    double cos = 1;
    double sin = 0;
};
Turn turn(std::uint64_t k, std::uint64_t n);

/// Smooth noise in [-1, 1] with features of size 1; |coordinates| < 2^31.
double noise(Point p, std::uint64_t seed);

/// Sum of `octaves` terms of noise, each with twice the frequency and half the height of the previous one.
double fractal_noise(Point p, int octaves, std::uint64_t seed);

/// A mesh with positions under construction.
class Builder {
  public:
    void reserve(std::uint64_t vertices, std::uint64_t triangles);
    /// Adds a vertex and returns its index. The caller ensures that there are at most kMostVertices.
    std::uint32_t vertex(Point p);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::uint32_t abc[3] = {a, b, c};
        mesh_.indices.insert(mesh_.indices.end(), abc, abc + 3);
    }
    /// Adds two triangles for the quad a, b, c, d; the diagonal is ac, or bd if `other`.
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool other = false) {
        if (other) {
            triangle(a, b, d);
            triangle(b, c, d);
        } else {
            triangle(a, b, c);
            triangle(a, c, d);
        }
    }
    std::uint32_t vertices() const { return mesh_.vertex_count; }
    std::uint64_t triangles() const { return mesh_.indices.size() / 3; }
    Mesh& mesh() { return mesh_; }
    /// Returns the mesh with its POSITION.
    Mesh finish();

  private:
    Mesh mesh_;
    std::vector<std::byte> positions_;
};

/// Is `made` at most 2 % or 64 triangles more than `wanted`?
constexpr bool within_limit(std::uint64_t made, std::uint64_t wanted) {
    return made <= wanted + (wanted / 50 > 64 ? wanted / 50 : 64);
}

/// The relative error |made - wanted| / wanted, which the searches for grid sizes minimize.
constexpr double misfit(std::uint64_t made, std::uint64_t wanted) {
    const std::uint64_t difference = made > wanted ? made - wanted : wanted - made;
    return static_cast<double>(difference) / static_cast<double>(wanted);
}

/// The square root, rounded down.
std::uint64_t square_root(std::uint64_t n);

Error too_many_generated();

/// A sphere of m sectors: two caps of f rings and a band of e rows. Ring i, 0 <= i <= 2f+e, has m*min(i, f, 2f+e-i)
/// vertices. m = 5 and e = f give the subdivided icosahedron.
struct SphereShape {
    std::uint64_t sectors = 5;  ///< m
    std::uint64_t cap = 1;      ///< f
    std::uint64_t band = 0;     ///< e

    std::uint64_t rows() const { return 2 * cap + band; }
    std::uint64_t ring_size(std::uint64_t i) const {
        const std::uint64_t j = i < rows() - i ? i : rows() - i;
        return sectors * (j < cap ? j : cap);
    }
    std::uint64_t triangles() const { return 2 * sectors * cap * (cap + band); }
    std::uint64_t vertices() const { return triangles() / 2 + 2; }
};
SphereShape sphere_shape(std::uint64_t triangles);
/// The unit sphere, facing outwards, with rings from the north pole to the south pole.
Builder build_sphere(const SphereShape& shape);

Result<Mesh> make_sphere(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_torus(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_genus(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_terrain(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_blob(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_parts(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_moebius(std::uint64_t triangles, std::uint64_t seed);
Result<Mesh> make_soup(std::uint64_t triangles, std::uint64_t seed);

}  // namespace lacedring::detail
