#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lrlab/generate/generate.h"
#include "tests/support/meshes.h"

using namespace lacedring;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

namespace {

std::uint64_t fnv(std::uint64_t hash, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ULL;
    return hash;
}

std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = fnv(0xcbf29ce484222325ULL, mesh.indices.data(), mesh.indices.size() * 4);
    for (const Attribute& a : mesh.attributes) hash = fnv(hash, a.data.data(), a.data.size());
    return hash;
}

/// Counts of a mesh, found from its half-edges by a simple algorithm.
struct Survey {
    std::map<Edge, std::uint32_t> half_edges;
    std::size_t edges = 0;
    std::size_t border = 0;        ///< edges with one triangle
    std::size_t nonmanifold = 0;   ///< edges with three or more
    std::size_t inconsistent = 0;  ///< half-edges that two triangles share
    std::size_t used_vertices = 0;
    std::size_t components = 0;    ///< triangles are joined by vertices
    std::size_t border_loops = 0;  ///< valid if each border vertex starts and ends one border edge
    std::size_t fans = 0;          ///< sum over vertices; a fan's triangles are joined by edges
    std::size_t degenerate = 0;
    long euler = 0;
};

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

Survey survey(const Mesh& mesh) {
    Survey s;
    const auto& I = mesh.indices;
    std::vector<std::uint32_t> parent(mesh.vertex_count);
    std::iota(parent.begin(), parent.end(), 0U);
    std::map<Edge, std::vector<std::uint32_t>> corners_of_edge;  // by triangle: the corners at both ends
    std::vector<bool> used(mesh.vertex_count);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const std::uint32_t v[3] = {I[3 * t], I[3 * t + 1], I[3 * t + 2]};
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            ++s.degenerate;
            continue;
        }
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i];
            const std::uint32_t b = v[(i + 1) % 3];
            if (++s.half_edges[{a, b}] > 1) ++s.inconsistent;
            corners_of_edge[std::minmax(a, b)].push_back(3 * t + i);
            parent[root(parent, a)] = root(parent, b);
            used[a] = true;
        }
    }
    std::vector<std::uint32_t> fan(I.size());  // union-find of the corners at a vertex
    std::iota(fan.begin(), fan.end(), 0U);
    for (const auto& [edge, corners] : corners_of_edge) {
        ++s.edges;
        if (corners.size() == 1) ++s.border;
        if (corners.size() > 2) ++s.nonmanifold;
        for (const std::uint32_t c : corners) {
            const std::uint32_t first = corners[0];
            const auto at = [&](std::uint32_t corner, std::uint32_t v) {
                return I[corner] == v ? corner : corner % 3 == 2 ? corner - 2 : corner + 1;
            };
            for (const std::uint32_t v : {edge.first, edge.second}) {
                fan[root(fan, at(c, v))] = root(fan, at(first, v));
            }
        }
    }
    for (std::uint32_t c = 0; c < I.size(); ++c) s.fans += root(fan, c) == c ? 1 : 0;
    s.fans -= 3 * s.degenerate;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        if (!used[v]) continue;
        ++s.used_vertices;
        if (root(parent, v) == v) ++s.components;
    }
    std::map<std::uint32_t, std::uint32_t> loop;
    for (const auto& [edge, corners] : corners_of_edge) {
        if (corners.size() != 1) continue;
        loop.try_emplace(edge.first, edge.first);
        loop.try_emplace(edge.second, edge.second);
    }
    const auto loop_root = [&](std::uint32_t v) {
        while (loop[v] != v) v = loop[v];
        return v;
    };
    for (const auto& [edge, corners] : corners_of_edge) {
        if (corners.size() == 1) loop[loop_root(edge.first)] = loop_root(edge.second);
    }
    for (const auto& [v, p] : loop) s.border_loops += v == p ? 1 : 0;
    s.euler = static_cast<long>(s.used_vertices) - static_cast<long>(s.edges) +
              static_cast<long>(mesh.triangle_count() - s.degenerate);
    return s;
}

Mesh make(std::string_view kind, std::uint64_t triangles, std::uint64_t seed) {
    Result<Mesh> mesh = generate(kind, triangles, seed);
    REQUIRE_MESSAGE(mesh.has_value(), kind << " " << triangles << " " << seed);
    return std::move(*mesh);
}

/// Checks that the mesh is manifold (at most two triangles per edge, one fan per vertex) and connected, and uses every
/// vertex.
void check_manifold(const Survey& s, const Mesh& mesh) {
    CHECK(s.nonmanifold == 0);
    CHECK(s.fans == s.used_vertices);
    CHECK(s.used_vertices == mesh.vertex_count);
    CHECK(s.components == 1);
    CHECK(s.degenerate == 0);
}

void check_closed(const Mesh& mesh, long genus) {
    const Survey s = survey(mesh);
    check_manifold(s, mesh);
    CHECK(s.border == 0);
    CHECK(s.inconsistent == 0);
    CHECK(s.euler == 2 - 2 * genus);
}

constexpr std::uint64_t sizes[] = {0, 1, 7, 8, 20, 63, 100, 251, 800, 1000, 3001, 9999, 20000};

}  // namespace

namespace {

void check_triangle_count(std::uint64_t count, std::uint64_t wanted, std::uint64_t smallest) {
    INFO("the mesh has about as many triangles as wanted");
    CHECK(count >= 1);
    CHECK(count <= std::max(wanted, smallest) + std::max<std::uint64_t>(64, wanted / 50));
    if (wanted >= std::max<std::uint64_t>(smallest, 1000)) {
        CHECK(static_cast<double>(count) >= 0.97 * static_cast<double>(wanted));
    }
}

void check_generated(const Mesh& mesh) {
    INFO("indices are in range, and the only attribute is finite float positions");
    REQUIRE(mesh.indices.size() % 3 == 0);
    CHECK(
        std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t v) { return v < mesh.vertex_count; }));
    REQUIRE(mesh.attributes.size() == 1);
    const Attribute& position = mesh.attributes[0];
    CHECK(position.name == "POSITION");
    CHECK(position.type == ComponentType::f32);
    CHECK(position.components == 3);
    CHECK(position.data.size() == std::size_t{12} * mesh.vertex_count);
    const std::vector<float> p = positions_f32(mesh);
    CHECK(std::all_of(p.begin(), p.end(), [](float x) { return std::isfinite(x); }));
}

}  // namespace

TEST_CASE("every generator makes a valid mesh of about the wanted size, the same on each call") {
    for (const GeneratorInfo& info : generators()) {
        CAPTURE(info.name);
        std::uint64_t smallest = 0;
        for (const std::uint64_t triangles : sizes) {
            CAPTURE(triangles);
            for (const std::uint64_t seed : {1U, 2U, 29U}) {
                CAPTURE(seed);
                const Mesh mesh = make(info.name, triangles, seed);
                if (triangles == 0) smallest = std::max(smallest, std::uint64_t{mesh.triangle_count()});
                check_triangle_count(mesh.triangle_count(), triangles, smallest);
                check_generated(mesh);
                CHECK_MESSAGE(hash_of(mesh) == hash_of(make(info.name, triangles, seed)), "the same on each call");
            }
        }
    }
}

TEST_CASE("another seed makes another mesh, except of the generators without randomness") {
    const std::set<std::string_view> fixed{"sphere", "torus", "moebius"};
    for (const GeneratorInfo& info : generators()) {
        CAPTURE(info.name);
        const bool same = hash_of(make(info.name, 2000, 4)) == hash_of(make(info.name, 2000, 5));
        CHECK(same == (fixed.count(info.name) == 1));
    }
}

TEST_CASE("generated meshes have the recorded bits") {
    // Recorded on x86-64 with g++ 12; every machine and compiler must make the same.
    const std::map<std::string_view, std::uint64_t> known{
        {"sphere", 0x801403667a8191a9},  {"torus", 0xef4ce99380f4c3d1}, {"genus", 0x24fcb05a43259d2e},
        {"terrain", 0xa6da95f02abf9fed}, {"blob", 0xefb54f3282f1e648},  {"parts", 0x9dd262356bc8af4a},
        {"moebius", 0x7e6690fb41f3f652}, {"soup", 0x975f7590cac108c5}};
    REQUIRE(known.size() == generators().size());
    for (const GeneratorInfo& info : generators()) {
        CAPTURE(info.name);
        CHECK(hash_of(make(info.name, 3000, 7)) == known.at(info.name));
    }
}

TEST_CASE("sphere, torus and blob are closed surfaces") {
    for (const std::uint64_t triangles : sizes) {
        CAPTURE(triangles);
        check_closed(make("sphere", triangles, 1), 0);
        check_closed(make("torus", triangles, 1), 1);
        for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
            CAPTURE(seed);
            check_closed(make("blob", triangles, seed), 0);
        }
    }
}

TEST_CASE("the blob's valences are irregular") {
    const Mesh mesh = make("blob", 10000, 1);
    std::vector<int> valence(mesh.vertex_count);
    for (const std::uint32_t v : mesh.indices) ++valence[v];
    const auto six = std::count(valence.begin(), valence.end(), 6);
    CHECK(six < mesh.vertex_count * 6 / 10);
    CHECK(*std::max_element(valence.begin(), valence.end()) <= 12);
    CHECK(*std::min_element(valence.begin(), valence.end()) >= 3);
}

TEST_CASE("genus grows with the seed") {
    for (std::uint64_t seed = 0; seed < 31; ++seed) {
        CAPTURE(seed);
        for (const std::uint64_t triangles : {0U, 2000U, 7777U}) {
            CAPTURE(triangles);
            check_closed(make("genus", triangles, seed), static_cast<long>(2 + seed % 30));
        }
    }
}

TEST_CASE("terrain is a disc with several holes") {
    for (const std::uint64_t triangles : sizes) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            CAPTURE(triangles);
            CAPTURE(seed);
            const Mesh mesh = make("terrain", triangles, seed);
            const Survey s = survey(mesh);
            check_manifold(s, mesh);
            CHECK(s.inconsistent == 0);
            CHECK(s.border_loops >= 3);
            CHECK(s.border_loops <= 17);
            CHECK(s.euler == 2 - static_cast<long>(s.border_loops));
        }
    }
}

TEST_CASE("the Moebius strip has one border and is not orientable") {
    for (const std::uint64_t triangles : sizes) {
        CAPTURE(triangles);
        const Mesh mesh = make("moebius", triangles, 1);
        const Survey s = survey(mesh);
        check_manifold(s, mesh);
        CHECK(s.border_loops == 1);
        CHECK(s.euler == 0);
        // Flipping triangles does not help: a surface with one border loop and Euler characteristic 0 is not an
        // annulus.
        CHECK(s.inconsistent > 0);
    }
}

TEST_CASE("parts are many manifold pieces of exactly the wanted number of triangles") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        CAPTURE(seed);
        const Mesh mesh = make("parts", 20000, seed);
        CHECK(mesh.triangle_count() == 20000);
        const Survey s = survey(mesh);
        CHECK(s.nonmanifold == 0);
        CHECK(s.inconsistent == 0);
        CHECK(s.fans == s.used_vertices);
        CHECK(s.degenerate == 0);
        CHECK(s.components > 1000);
        CHECK(s.border > 1000);
    }
}

TEST_CASE("the soup has degenerate triangles, borders, non-manifold edges and vertices, and unused vertices") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        CAPTURE(seed);
        const Mesh mesh = make("soup", 3000, seed);
        CHECK(mesh.triangle_count() == 3000);
        const Survey s = survey(mesh);
        CHECK(s.nonmanifold > 10);
        CHECK(s.inconsistent > 10);
        CHECK(s.border > 10);
        CHECK(s.degenerate > 5);
        CHECK_MESSAGE(s.fans > s.used_vertices + 10, "vertices of two fans");
        CHECK_MESSAGE(s.used_vertices + 10 < mesh.vertex_count, "unused vertices");
        auto triangles = test::oriented_triangles(mesh.indices);
        CHECK(std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end());
        std::set<std::array<std::uint32_t, 3>> set(triangles.begin(), triangles.end());
        CHECK(std::any_of(set.begin(), set.end(), [&](const auto& t) { return set.count({t[0], t[2], t[1]}) != 0; }));
    }
}

TEST_CASE("unknown generators and huge sizes are refused") {
    const auto unknown = generate("teapot", 100);
    REQUIRE(!unknown);
    CHECK(unknown.error().code == ErrorCode::invalid_argument);
    CHECK(unknown.error().message.find("teapot") != std::string::npos);
    for (const GeneratorInfo& info : generators()) {
        CAPTURE(info.name);
        for (const std::uint64_t triangles : {std::uint64_t{1} << 31, std::uint64_t{1} << 62, UINT64_MAX}) {
            const auto large = generate(info.name, triangles);
            REQUIRE(!large);
            CHECK(large.error().code == ErrorCode::invalid_argument);
        }
        CHECK(!info.description.empty());
        CHECK(make(info.name, 100, UINT64_MAX).triangle_count() > 0);
    }
}

namespace {

std::map<std::string, Mesh> named_meshes_by_name() {
    std::map<std::string, Mesh> meshes;
    for (auto& named : test::named_meshes()) {
        CAPTURE(named.name);
        CHECK(named.mesh.indices.size() % 3 == 0);
        CHECK(std::all_of(named.mesh.indices.begin(), named.mesh.indices.end(),
                          [&](std::uint32_t v) { return v < named.mesh.vertex_count; }));
        CHECK_MESSAGE(meshes.emplace(named.name, std::move(named.mesh)).second, "names are unique");
    }
    return meshes;
}

}  // namespace

TEST_CASE("test support: named meshes have the topology that their names state") {
    std::map<std::string, Mesh> meshes = named_meshes_by_name();
    SUBCASE("closed orientable surfaces have their genus") {
        const std::map<std::string, long> closed{{"tetrahedron", 0},
                                                 {"octahedron", 0},
                                                 {"cube", 0},
                                                 {"genus 1 plate", 1},
                                                 {"genus 2 plate", 2},
                                                 {"genus 5 plate", 5},
                                                 {"smallest torus", 1},
                                                 {"torus", 1},
                                                 {"Apollonian network", 0},
                                                 {"random stack", 0},
                                                 {"spiral stack", 0},
                                                 {"bipyramid of 500", 0},
                                                 {"double fan of 1", 0},
                                                 {"double fan of 200", 0},
                                                 {"double fan, shuffled", 0},
                                                 {"octahedron subdivided", 0},
                                                 {"twice stacked torus", 1}};
        for (const auto& [mesh_name, genus] : closed) {
            const std::string& name = mesh_name;
            CAPTURE(name);
            REQUIRE(meshes.count(name) == 1);
            check_closed(meshes[name], genus);
        }
    }
    SUBCASE("closed surfaces that are not orientable have their Euler characteristic") {
        for (const auto& [mesh_name, euler] :
             std::map<std::string, long>{{"Klein bottle", 0}, {"projective plane", 1}}) {
            const std::string& name = mesh_name;
            CAPTURE(name);
            const Survey s = survey(meshes[name]);
            check_manifold(s, meshes[name]);
            CHECK(s.border == 0);
            CHECK(s.euler == euler);
            CHECK(s.inconsistent > 0);
        }
    }
    SUBCASE("surfaces with borders have their number of border loops") {
        for (const auto& [mesh_name, loops] : std::map<std::string, std::size_t>{{"annulus", 2},
                                                                                 {"thin annulus", 2},
                                                                                 {"disc", 1},
                                                                                 {"Moebius strip of 5", 1},
                                                                                 {"smallest Moebius strip", 1},
                                                                                 {"disc with holes", 13},
                                                                                 {"strip", 1}}) {
            const std::string& name = mesh_name;
            CAPTURE(name);
            CHECK(survey(meshes[name]).border_loops == loops);
        }
    }
    SUBCASE("a non-manifold edge, a vertex of two fans, degenerate triangles") {
        CHECK(survey(meshes["four triangles on an edge"]).nonmanifold == 1);
        CHECK(survey(meshes["bow-tie"]).fans == 6);
        CHECK(survey(meshes["degenerate triangles only"]).degenerate == 4);
    }
}

TEST_CASE("test support: oriented_triangles ignores order, rotation and degenerate triangles") {
    const std::vector<std::uint32_t> a{0, 1, 2, 5, 4, 3, 1, 1, 2};
    const std::vector<std::uint32_t> b{4, 3, 5, 2, 0, 1};
    const std::vector<std::uint32_t> turned{4, 5, 3, 2, 0, 1};
    CHECK(test::oriented_triangles(a) == test::oriented_triangles(b));
    CHECK(test::oriented_triangles(a) != test::oriented_triangles(turned));
    CHECK(test::oriented_triangles({}).empty());
    CHECK(test::oriented_triangles(test::random_soup(4, 100, 1, false).indices).size() == 100);
}
