// Tests outlines that are drawn without a list of edges: which edges are drawn, and where.

#include <cstdint>
#include <numbers>

#include "spirv/silhouette_edges_comp.h"
#include "tests/gpu/adjacency_test.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

struct EdgeTest : AdjacencyTest {
    EdgeTest() : edges(pipeline(spirv_silhouette_edges_comp)) {}

    static constexpr double kCrease = 40;

    /// The kind of each line, computed on the device by the function of silhouette.vert.
    std::vector<std::uint32_t> kinds(const gpu::Adjacency& adjacency, const std::array<float, 3>& eye, double crease) {
        const std::uint32_t lines = 3 * adjacency.triangle_numbers;
        const gpu::Buffer out = buffer(std::size_t{4} * lines);
        constexpr std::uint32_t kBatch = 1U << 21;
        for (std::uint32_t first = 0; first < lines; first += kBatch) {
            struct {
                gpu::SilhouetteConstants constants;
                std::array<float, 3> eye;
            } push{{{}, {}, first, static_cast<float>(std::cos(crease * std::numbers::pi / 180))}, eye};
            run(edges, {&adjacency.tables, &adjacency.positions, &out, &out}, &push, sizeof(push),
                std::min(kBatch, lines - first));
        }
        return read<std::uint32_t>(out, lines);
    }

    /// The kind of the edge opposite to c, from the corner table. `unsure`: rounding may change it.
    static std::uint32_t kind_of(const Tables& tables, CornerId c, const Point3& eye, bool& unsure) {
        const CornerTable& table = tables.table;
        const CornerId o = table.opposite(c);
        unsure = false;
        if (o.is_null()) return LR_EDGE_BORDER;
        const Positions positions{std::span<const float>(tables.positions)};
        const Point3 a = positions[table.vertex(next(c))], along = minus(positions[table.vertex(previous(c))], a);
        const Point3 p = minus(positions[table.vertex(c)], a), q = minus(positions[table.vertex(o)], a);
        const Point3 near = cross(along, p), far = cross(q, along), to_eye = minus(eye, a);
        constexpr double kRounding = 1e-6;
        const double near_size = length(along) * length(p), far_size = length(along) * length(q);
        const double near_faces = dot(near, to_eye), far_faces = dot(far, to_eye);
        unsure = std::abs(near_faces) <= kRounding * near_size * length(to_eye) ||
                 std::abs(far_faces) <= kRounding * far_size * length(to_eye);
        const double lengths = length(near) * length(far), limit = std::cos(kCrease * std::numbers::pi / 180) * lengths;
        unsure = unsure || std::abs(dot(near, far) - limit) <=
                               2 * kRounding * (near_size * length(far) + far_size * length(near));
        std::uint32_t kind = (near_faces > 0) != (far_faces > 0) ? LR_EDGE_SILHOUETTE : 0;
        if (lengths > 0 && dot(near, far) < limit) kind |= LR_EDGE_CREASE;
        return kind;
    }

    void check(const Tables& tables) {
        const auto adjacency = gpu::upload_adjacency(*context, *transfer, tables.encoded, tables.positions);
        REQUIRE_MESSAGE(adjacency, adjacency.error().message);
        const std::array<float, 3> eye{1.3F, 0.9F, 2.7F};
        std::vector<std::uint32_t> got = kinds(*adjacency, eye, kCrease);
        std::vector<std::uint32_t> line(tables.table.corners.size(), UINT32_MAX);  // by corner of the corner table
        const LrMap& map = tables.map;
        for (std::uint32_t t = 0; t < map.triangle.size(); ++t) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                if (map.triangle[t].is_null()) {
                    REQUIRE(got[3 * t + k] == 0);
                } else {
                    line[corner(map.triangle[t], (map.start[t] + k) % 3).value] = 3 * t + k;
                }
            }
        }
        for (std::uint32_t i = 0; i < line.size(); ++i) {
            if (line[i] == UINT32_MAX) continue;
            const CornerId o = tables.table.opposite(CornerId{i});
            if (!o.is_null() && o.value < i) continue;
            std::uint32_t kind = got[line[i]];
            if (!o.is_null()) {
                REQUIRE_MESSAGE((kind == 0 || got[line[o.value]] == 0), "an edge is drawn once");
                kind |= got[line[o.value]];
            }
            bool unsure = false;
            const std::uint32_t expected = kind_of(tables, CornerId{i}, {eye[0], eye[1], eye[2]}, unsure);
            ++measured.edges;
            measured.drawn += expected != 0 ? 1 : 0;
            measured.near_edges += unsure ? 1 : 0;
            if (kind == expected) continue;
            ++measured.other;
            if (!unsure) CHECK(kind == expected);
        }
        ++measured.meshes;
    }

    gpu::PipelineHandle edges;
};

}  // namespace

TEST_CASE_FIXTURE(EdgeTest,
                  "the edges that the tables have drawn are the corner table's borders, outlines and creases") {
    every_mesh([&](const Mesh& mesh, std::uint32_t seed) {
        std::vector<float> positions = model_positions(mesh);
        if (positions.empty()) return;
        const auto tables = tables_of(mesh, std::move(positions), seed % 2 == 1);
        if (tables != nullptr) check(*tables);
    });
    CHECK(measured.drawn > 0);
    MESSAGE(measured.meshes, " meshes, ", measured.edges, " edges, ", measured.drawn, " drawn; ", measured.near_edges,
            " near a limit, of which ", measured.other, " differ");
}

namespace {

constexpr std::uint32_t kSide = 480;

/// The picture of a surface with its outline in pure red.
gpu::Picture outlined(gpu::Context& context, const gpu::Model& model, const gpu::Camera& camera, double crease,
                      std::uint32_t lines_per_draw) {
    gpu::RendererOptions options;
    // The wire view pushes the surface back a little. Its lines are left out.
    options.view = gpu::View::wire;
    options.width = options.height = kSide;
    auto renderer = gpu::Renderer::create(context, options);
    REQUIRE(renderer);
    auto drawable = renderer->upload(model, gpu::Source::plain);
    const auto adjacency = gpu::upload_adjacency(context, renderer->transfer(), model);
    auto silhouettes = gpu::Silhouettes::create(context, lines_per_draw);
    REQUIRE((drawable && adjacency && silhouettes));
    drawable->mesh.line_indices = 0;
    renderer->painter().set_frame(model, camera, renderer->target());
    silhouettes->set_frame(camera, renderer->target(), {.crease = crease, .color = {1, 0, 0, 1}, .width = 1});
    const auto commands = renderer->commands().begin();
    REQUIRE(commands);
    renderer->painter().record(*commands, drawable->mesh, drawable->draw, renderer->target(),
                               gpu::Painter::Ties::first_drawn);
    silhouettes->record(*commands, *adjacency, renderer->target());
    renderer->target().record_read(*commands);
    REQUIRE(renderer->commands().run());
    return renderer->target().picture();
}

bool red(const gpu::Picture& picture, std::size_t pixel) {
    const std::uint8_t* p = &picture.rgba[4 * pixel];
    return p[0] == 255 && p[1] == 0 && p[2] == 0 && p[3] == 255;
}

/// Returns whether there is red within `around` pixels of the projection of `point`.
bool red_near(const gpu::Picture& picture, const gpu::Camera& camera, const Point3& point, int around) {
    std::array<double, 4> view{0, 0, 0, 1}, clip{};
    for (std::size_t row = 0; row < 3; ++row) {
        view[row] = camera.view_from_world[12 + row];
        for (std::size_t i = 0; i < 3; ++i) view[row] += camera.view_from_world[4 * i + row] * point[i];
    }
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t i = 0; i < 4; ++i) clip[row] += camera.clip_from_view[4 * i + row] * view[i];
    }
    const int x = static_cast<int>((clip[0] / clip[3] + 1) / 2 * kSide);
    const int y = static_cast<int>((1 - clip[1] / clip[3]) / 2 * kSide);
    for (int j = y - around; j <= y + around; ++j) {
        for (int i = x - around; i <= x + around; ++i) {
            if (i >= 0 && j >= 0 && i < int{kSide} && j < int{kSide} &&
                red(picture, static_cast<std::size_t>(j) * kSide + static_cast<std::size_t>(i))) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace

TEST_CASE_FIXTURE(EdgeTest, "a sphere's outline is drawn at its silhouette") {
    const Mesh mesh = generated("sphere", 500);
    const gpu::Model model = model_of(mesh);
    const auto camera = gpu::make_camera(model, {}, kSide, kSide);
    REQUIRE(camera);
    const auto tables = tables_of(mesh, model.positions, true);
    REQUIRE(tables);
    const gpu::Picture outline = outlined(*context, model, *camera, 180, UINT32_MAX);
    const gpu::Picture all = outlined(*context, model, *camera, 0, UINT32_MAX);
    const std::array<float, 3> e = gpu::eye_of(*camera);
    const Point3 eye{e[0], e[1], e[2]};
    const Positions positions{std::span<const float>(tables->positions)};
    std::size_t silhouette = 0, front = 0;
    for (std::uint32_t i = 0; i < tables->table.corners.size(); ++i) {
        bool unsure = false;
        const std::uint32_t kind = kind_of(*tables, CornerId{i}, eye, unsure);
        const Point3 a = positions[tables->table.vertex(next(CornerId{i}))],
                     b = positions[tables->table.vertex(previous(CornerId{i}))];
        const Point3 middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
        if (kind == LR_EDGE_SILHOUETTE) {
            ++silhouette;
            CHECK(red_near(outline, *camera, middle, 1));
            CHECK(red_near(all, *camera, middle, 1));
        } else if (dot(middle, eye) > 0.6 * length(middle) * length(eye)) {  // in front, well inside the outline
            ++front;
            CHECK_FALSE(red_near(outline, *camera, middle, 2));
            CHECK(red_near(all, *camera, middle, 1));
        }
    }
    CHECK(silhouette > 20);
    CHECK(front > 100);

    // The outline in many draws equals that in one.
    const gpu::Difference parts = gpu::difference(outlined(*context, model, *camera, 180, 100), outline);
    CHECK(parts.pixels == 0);
    CHECK(parts.triangles == 0);
    CHECK(parts.covered > 0);
}

TEST_CASE_FIXTURE(EdgeTest, "an outline is drawn without a surface") {
    const Mesh mesh = generated("terrain", 2000);
    const gpu::Model model = model_of(mesh);
    const auto camera = gpu::make_camera(model, {}, kSide, kSide);
    const auto adjacency = gpu::upload_adjacency(*context, *transfer, model);
    auto silhouettes = gpu::Silhouettes::create(*context);
    const auto target = gpu::Target::create(*context, {kSide, kSide});
    REQUIRE((camera && adjacency && silhouettes && target));
    silhouettes->set_frame(*camera, *target, {.crease = 180, .color = {1, 0, 0, 1}, .width = 1});
    const auto recording = commands->begin();
    REQUIRE(recording);
    target->prepare(*recording);
    target->begin(*recording, {.color = true, .triangles = true, .clear_color = true, .clear_depth = true});
    gpu::Target::end(*recording);
    silhouettes->record(*recording, *adjacency, *target);
    target->record_read(*recording);
    REQUIRE(commands->run());
    const gpu::Picture picture = target->picture();
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < picture.pixels(); ++i) drawn += red(picture, i) ? 1 : 0;
    CHECK_MESSAGE(drawn > kSide, "the border is longer than the picture is wide");
}
