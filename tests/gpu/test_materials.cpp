// Tests materials: their textures, and their pictures from every source by every path.

#include <array>
#include <filesystem>

#include "lacedring/mesh_files.hpp"
#include "lacedring/surface.hpp"
#include "renderer/draw/png.h"
#include "renderer/mesh/textures.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/capture.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

constexpr std::uint32_t kBlack = 0xff000000, kWhite = 0xffffffff;

std::vector<std::byte> png_of(std::uint32_t width, std::uint32_t height) {
    gpu::Picture picture;
    picture.width = width;
    picture.height = height;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        for (const std::uint32_t c : {10 * i, 255 - i, i % 2 * 200, 255U})
            picture.rgba.push_back(static_cast<std::uint8_t>(c));
    }
    Result<std::vector<std::byte>> png = gpu::encode_png(picture);
    REQUIRE(png);
    return std::move(png).value();
}

struct DrawnMesh {
    Mesh mesh;
    Materials materials;
    Surface surface;
};

DrawnMesh asset(const char* name) {
    DrawnMesh out;
    Result<Mesh> mesh =
        read_mesh(std::filesystem::path(LACEDRING_ASSETS) / name, ReadOptions{}, nullptr, &out.materials);
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    out.mesh = std::move(*mesh);
    out.surface = find_surface(out.mesh);
    return out;
}

/// A square of one material in the plane z = 0, seen from the front.
struct Square {
    Mesh mesh{4, {0, 1, 2, 0, 2, 3}, {}};
    Materials materials{{Material{}}, {}, {0, 0}};

    Square() {
        constexpr std::array<float, 12> kCorners{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
        constexpr std::array<float, 8> kTexture{0, 1, 1, 1, 1, 0, 0, 0};
        const auto bytes = [](const auto& values) {
            const auto from = std::as_bytes(std::span(values));
            return std::vector<std::byte>(from.begin(), from.end());
        };
        mesh.attributes.push_back({"POSITION", ComponentType::f32, 3, false, bytes(kCorners)});
        mesh.attributes.push_back({"TEXCOORD_0", ComponentType::f32, 2, false, bytes(kTexture)});
        material().unlit = true;
    }
    Material& material() { return materials.materials[0]; }

    /// The pixel at (x, y) of the square, from its left upper corner; black if nothing is drawn there.
    std::array<std::uint8_t, 3> pixel(gpu::Renderer& renderer, double x, double y, bool behind = false) {
        gpu::Model model = model_of(mesh);
        gpu::add_materials(model, mesh, materials);
        Result<gpu::Drawable> drawable = renderer.upload(model, gpu::Source::plain);
        REQUIRE_MESSAGE(drawable, drawable.error().message);
        gpu::CameraOptions options;
        options.direction = {0, 0, behind ? -1.0 : 1.0};
        const auto camera = gpu::make_camera(model, options, kWidth, kHeight);
        REQUIRE(camera);
        const Result<gpu::Picture> picture = renderer.draw(*drawable, model, *camera, true);
        REQUIRE_MESSAGE(picture, picture.error().message);
        // The square fills nearly all of the picture's height.
        std::uint32_t left = kWidth, right = 0, top = kHeight, bottom = 0;
        for (std::uint32_t i = 0; i < picture->pixels(); ++i) {
            if (picture->triangles[i] == 0) continue;
            left = std::min(left, i % kWidth);
            right = std::max(right, i % kWidth);
            top = std::min(top, i / kWidth);
            bottom = std::max(bottom, i / kWidth);
        }
        if (left > right) return {};
        const auto at_x = left + static_cast<std::uint32_t>(x * (right - left)),
                   at_y = top + static_cast<std::uint32_t>(y * (bottom - top));
        const std::uint8_t* p = &picture->rgba[4 * (std::size_t{at_y} * kWidth + at_x)];
        return {p[0], p[1], p[2]};
    }
};

bool near(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) {
    for (std::size_t c = 0; c < 3; ++c) {
        if (std::abs(int{a[c]} - int{b[c]}) > 3) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("mip maps: a texel is the mean of four, for colors of their linear values") {
    for (const bool is_color : {false, true}) {
        std::vector<std::uint32_t> texels{kBlack, kWhite, kWhite, kBlack, kWhite, kWhite};  // 3 by 2
        CHECK(gpu::append_mip_maps(texels, 3, 2, is_color) == 2);
        REQUIRE(texels.size() == 7);
        const std::uint32_t red = texels[6] & 255;  // the mean of two black and two white texels
        CHECK(red >= (is_color ? 187 : 127));
        CHECK(red <= (is_color ? 189 : 128));
        const std::uint32_t alpha = texels[6] >> 24;
        CHECK(alpha == 255);
    }
    std::vector<std::uint32_t> one{0x12345678};
    CHECK(gpu::append_mip_maps(one, 1, 1, true) == 1);
    std::vector<std::uint32_t> line(5, kWhite);
    CHECK_MESSAGE(gpu::append_mip_maps(line, 1, 5, true) == 3, "heights 5, 2, 1");
    CHECK(line == std::vector<std::uint32_t>(8, kWhite));
}

TEST_CASE("textures: bytes that are no image are noted and left out") {
    Materials materials;
    materials.materials.resize(2);
    materials.materials[0].base.image = 1;
    materials.materials[0].normal.image = 0;
    materials.materials[1].emitting.image = 3;
    materials.materials[1].occluding.image = 4;
    materials.images = {png_of(5, 3), {std::byte{1}, std::byte{2}}, png_of(64, 64), png_of(7, 2), {}};
    std::vector<std::byte>& cut = materials.images[3];
    const gpu::Textures whole = gpu::decode_textures(materials);
    REQUIRE(whole.images.size() == 5);
    CHECK(whole.images[0].width == 5);
    CHECK(whole.images[0].height == 3);
    CHECK(whole.images[0].levels == 3);
    CHECK_MESSAGE(whole.images[2].width == 0, "an unused image is not decoded");
    CHECK(whole.images[3].first == 15 + 2 + 1);
    CHECK(whole.texels.size() == 15 + 2 + 1 + 14 + 3 + 1);
    CHECK(whole.texels[1] == (10U | 254U << 8 | 200U << 16 | 255U << 24));
    CHECK(whole.notes == std::vector<std::string>{"not drawn: image 1: neither PNG nor JPEG"});
    // A cut image may be refused or decoded in part; a sanitizer reports reads past its end.
    while (cut.size() > 1) {
        cut.resize(cut.size() - 1);
        (void)gpu::decode_textures(materials);
    }
}

TEST_CASE_FIXTURE(GpuTest, "materials: each property changes the picture") {
    gpu::RendererOptions options;
    options.view = gpu::View::material;
    options.width = kWidth;
    options.height = kHeight;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, options);
    REQUIRE_MESSAGE(renderer, renderer.error().message);
    using Color = std::array<std::uint8_t, 3>;
    const Color none{};
    Square square;
    square.material().base_color = {1, 0.2158605F, 0, 1};  // green is 128 in sRGB
    {
        INFO("base_color, and double_sided");
        CHECK(near(square.pixel(*renderer, 0.5, 0.5), Color{255, 128, 0}));
        CHECK(square.pixel(*renderer, 0.5, 0.5, true) == none);
        square.material().double_sided = true;
        CHECK(near(square.pixel(*renderer, 0.5, 0.5, true), Color{255, 128, 0}));
    }

    // Four texels, nearest: red and green above, blue and white below.
    gpu::Picture four;
    four.width = four.height = 2;
    four.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
    square.materials.images = {gpu::encode_png(four).value()};
    Material& m = square.material();
    m.base_color = {1, 1, 1, 1};
    m.base.image = 0;
    m.base.nearest = true;
    {
        INFO("the texture");
        CHECK(near(square.pixel(*renderer, 0.25, 0.25), Color{255, 0, 0}));
        CHECK(near(square.pixel(*renderer, 0.75, 0.25), Color{0, 255, 0}));
        CHECK(near(square.pixel(*renderer, 0.25, 0.75), Color{0, 0, 255}));
        CHECK(near(square.pixel(*renderer, 0.75, 0.75), Color{255, 255, 255}));
    }
    m.base.transform = {2, 0, 0, 0, 1, 0};
    {
        INFO("the transform: the texture twice across");
        CHECK(near(square.pixel(*renderer, 0.6, 0.25), Color{255, 0, 0}));
        CHECK(near(square.pixel(*renderer, 0.9, 0.25), Color{0, 255, 0}));
    }
    m.base.wrap_u = TextureWrap::mirror;
    {
        INFO("wrapping: mirror");
        CHECK(near(square.pixel(*renderer, 0.6, 0.25), Color{0, 255, 0}));
        CHECK(near(square.pixel(*renderer, 0.9, 0.25), Color{255, 0, 0}));
    }
    m.base.wrap_u = TextureWrap::clamp;
    CHECK_MESSAGE(near(square.pixel(*renderer, 0.9, 0.25), Color{0, 255, 0}), "wrapping: clamp");
    m.base.transform = {1, 0, 0, 0, 1, 0};

    m.base_color[3] = 0.4F;
    m.alpha = AlphaMode::mask;
    CHECK_MESSAGE(square.pixel(*renderer, 0.25, 0.25) == none, "alpha below the cutoff");
    m.cutoff = 0.4F;
    CHECK_MESSAGE(near(square.pixel(*renderer, 0.25, 0.25), Color{255, 0, 0}), "alpha at the cutoff");

    m = Material{};
    m.base_color = {0, 0, 0, 1};
    m.emissive = {0, 0, 0.5F};
    const Color glows = square.pixel(*renderer, 0.5, 0.5);
    CHECK_MESSAGE(glows[2] > glows[0] + 60, "emission is added");
    m = Material{};
    m.roughness = 0.2F;
    CHECK_MESSAGE(square.pixel(*renderer, 0.5, 0.5)[1] > 60, "metal reflects the sky");

    INFO("flat ignores the normals of vertices, also from behind");
    m = Material{};
    m.metallic = 0;
    const Color straight = square.pixel(*renderer, 0.5, 0.5);
    constexpr std::array<float, 12> kTilted{0.8F, 0, 0.6F, 0.8F, 0, 0.6F, 0.8F, 0, 0.6F, 0.8F, 0, 0.6F};
    const auto bytes = std::as_bytes(std::span(kTilted));
    square.mesh.attributes.push_back({"NORMAL", ComponentType::f32, 3, false, {bytes.begin(), bytes.end()}});
    CHECK_FALSE(near(square.pixel(*renderer, 0.5, 0.5), straight));
    m.flat = true;
    CHECK(near(square.pixel(*renderer, 0.5, 0.5), straight));
    m.double_sided = true;
    CHECK_FALSE(near(square.pixel(*renderer, 0.5, 0.5, true), Color{}));
}

TEST_CASE_FIXTURE(GpuTest, "materials: the same picture from every source by every path") {
    for (const auto& [name, flat] : {std::pair("materials.glb", false), std::pair("globe.glb", true)}) {
        CAPTURE_COPY(name);
        DrawnMesh drawn = asset(name);
        for (Material& m : drawn.materials.materials) m.flat = flat;
        gpu::ModelOptions options{.packed = true, .vertices = VertexOptions{}, .surface = drawn.surface};
        Result<gpu::Model> model = gpu::make_model(drawn.mesh, options);
        REQUIRE_MESSAGE(model, model.error().message);
        gpu::add_materials(*model, drawn.mesh, drawn.materials);
        std::vector<gpu::Subject> subjects;
        for (const auto& [path_name, path, label] : gpu::kPaths) {
            if (path == gpu::Path::mesh && context->info().max_mesh_groups == 0) continue;
            for (const gpu::Source source : {gpu::Source::lean, gpu::Source::packed, gpu::Source::packed_vertices}) {
                if (source != gpu::Source::packed_vertices || path == gpu::Path::compute)
                    subjects.push_back({source, path});
            }
        }
        gpu::CompareOptions how;
        how.width = kWidth;
        how.height = kHeight;
        how.view = gpu::View::material;
        const auto all = gpu::compare(*context, *model, subjects, how);
        REQUIRE_MESSAGE(all, all.error().message);
        for (const gpu::Comparison& c : *all) {
            CHECK(c.same());
            CHECK_FALSE(c.blank);
        }
    }
}

TEST_CASE_FIXTURE(GpuTest, "materials of another mesh are refused, and a mesh without materials is drawn") {
    Square square;
    gpu::Model model = model_of(square.mesh);
    gpu::RendererOptions options;
    options.view = gpu::View::material;
    options.width = kWidth;
    options.height = kHeight;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(*context, options);
    REQUIRE_MESSAGE(renderer, renderer.error().message);
    CHECK(renderer->upload(model, gpu::Source::lean).has_value());
    square.materials.of_triangle = {0};
    gpu::add_materials(model, square.mesh, square.materials);
    CHECK_FALSE(renderer->upload(model, gpu::Source::lean).has_value());
    square.materials.of_triangle = {0, 1};
    CHECK_FALSE(renderer->upload(model, gpu::Source::lean).has_value());
}
