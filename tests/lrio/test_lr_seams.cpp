// Tests .lr files of meshes with seams.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>

#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "lrlab/generate/generate.h"
#include "tests/lrio/lr_files.h"
#include "tests/support/capture.h"
#include "tests/support/cut_mesh.h"
#include "tests/support/cuts.h"
#include "tests/support/damage.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using test::CutMesh;
using test::Part;
using test::with_parts;

namespace {

LrFile make_cut(const CutMesh& cut, bool keep_order, Format format) {
    Result<LrFile> file =
        make_lr_file(cut.mesh, cut.surface, test::encode_as(format, surface_mesh(cut.mesh, cut.surface)), keep_order);
    REQUIRE_MESSAGE(file, file.error().message);
    return std::move(*file);
}

/// Adds an attribute "number": the number of each vertex.
Mesh with_numbers(Mesh mesh) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) numbers.push_back(v);
    const auto bytes = std::as_bytes(std::span(numbers));
    mesh.attributes.push_back({"number", ComponentType::u32, 1, false, {bytes.begin(), bytes.end()}});
    return mesh;
}

/// Returns whether the attribute is equal at all copies of each surface vertex.
bool agrees(const Attribute& attribute, const Surface& surface) {
    const std::vector<std::uint32_t> first = first_vertices(surface);
    for (std::size_t v = 0; v < surface.vertex_of.size(); ++v) {
        const std::byte* other = attribute.data.data() + first[surface.vertex_of[v]] * attribute.stride();
        if (std::memcmp(attribute.data.data() + v * attribute.stride(), other, attribute.stride()) != 0) return false;
    }
    return true;
}

void check_per_copy(const CutMesh& cut, const LrFile& file) {
    INFO("attributes that differ between the copies of a vertex are stored per copy, others per vertex");
    REQUIRE(file.attributes.size() == cut.mesh.attributes.size());
    for (std::size_t a = 0; a < file.attributes.size(); ++a) {
        CAPTURE(a);
        REQUIRE(file.attributes[a].per_copy == !agrees(cut.mesh.attributes[a], cut.surface));
    }
}

/// Does nothing if the mesh has no attribute "number" (with_numbers).
void check_partition(const CutMesh& cut, const Mesh& mesh, const Surface& surface) {
    if (!surface.has_seams() || mesh.attributes.back().name != "number") return;
    INFO("the decoded surface joins the same copies");
    std::vector<std::uint32_t> vertex_of;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        std::uint32_t number = 0;
        std::memcpy(&number, mesh.attributes.back().data.data() + 4 * std::size_t{v}, sizeof number);
        vertex_of.push_back(cut.surface.vertex_of[number]);
    }
    REQUIRE(test::same_partition(surface.vertex_of, vertex_of));
}

void check_decoded_surface(const CutMesh& cut, const LrFile& read) {
    Surface surface;
    const Result<Mesh> mesh = decode_lr(read, &surface);
    REQUIRE(mesh);
    REQUIRE(mesh->vertex_count == cut.mesh.vertex_count);
    test::ValueNumbers numbers;
    REQUIRE_MESSAGE(test::triangles_by_values(*mesh, numbers) == test::triangles_by_values(cut.mesh, numbers),
                    "the decoded triangles have the mesh's values");
    REQUIRE(surface.vertex_count == cut.surface.vertex_count);
    REQUIRE(surface.has_seams() == cut.surface.has_seams());
    check_partition(cut, *mesh, surface);
}

void check_seams_view(const LrFile& file, const std::vector<std::byte>& bytes) {
    INFO("the view has the file's copies, seams and attributes");
    const Result<LrFileView> view = view_lr_file(bytes);
    REQUIRE(view);
    REQUIRE(view->copy_count == file.copy_count);
    REQUIRE(std::ranges::equal(view->seams, file.seams));
    REQUIRE(
        std::ranges::equal(view->attributes, file.attributes, {}, &AttributeView::per_copy, &LrAttribute::per_copy));
    REQUIRE(view->validate());
}

void check_seams_listing(const LrFile& file, const std::vector<std::byte>& bytes) {
    INFO("the listing has the file's copies and, with copies, one section of seams");
    const Result<LrContents> listed = list_lr(bytes);
    REQUIRE(listed);
    REQUIRE(listed->copies == file.copy_count);
    REQUIRE(std::ranges::count(listed->sections, "seams", &LrSection::kind) == (file.copy_count > 0 ? 1 : 0));
}

/// Writes and reads a file and compares it with the mesh and its surface.
void check_file(const CutMesh& cut, const LrFile& file) {
    REQUIRE((file.copy_count > 0) == cut.surface.has_seams());
    check_per_copy(cut, file);
    const std::vector<std::byte> bytes = serialize_lr(file);
    const Result<LrFile> read = parse_lr(bytes);
    REQUIRE_MESSAGE(read, read.error().message);
    REQUIRE_MESSAGE(serialize_lr(*read) == bytes, "a parsed file is written unchanged");
    if (!file.corner_order.empty()) test::check_same_mesh(decode_lr_original_order(*read), cut.mesh);
    check_decoded_surface(cut, *read);
    check_seams_view(file, bytes);
    check_seams_listing(file, bytes);
}

CutMesh small_cut() {
    return test::cut_mesh(test::random_gluing(40, 80, 5), 2, 1);
}

void mend(std::vector<std::uint32_t>& seams) {
    seams[1] = crc32(std::as_bytes(std::span(seams).subspan(2)));
}

}  // namespace

TEST_CASE("lr files of named meshes, cut in every way, decode to the values at every corner") {
    std::uint64_t seed = 0;
    std::size_t extra = 0, unused = 0;
    for (const auto& [name, mesh] : test::named_meshes()) {
        if (mesh.triangle_count() > (test::kSanitized ? 150 : 1000)) continue;
        CAPTURE_COPY(name);
        for (std::uint32_t charting = 0; charting < test::kCuts; ++charting) {
            CAPTURE(charting);
            CutMesh cut = test::cut_mesh(mesh, charting, ++seed);
            if (seed % 3 != 0) cut.mesh = with_numbers(std::move(cut.mesh));
            for (std::size_t f = 0; f < std::size(test::kFormats); ++f) {
                if (mesh.triangle_count() > 200 && (seed + f) % 4 != 0) continue;
                const Format format = test::kFormats[f];
                CAPTURE(name_of(format));
                LrFile file = make_cut(cut, seed % 2 == 0, format);
                extra += file.vertex_count - mesh.vertex_count;
                check_file(cut, file);
                if (seed % 4 != f) continue;
                REQUIRE(compress_attributes(file));
                check_file(cut, file);
            }
        }
        std::vector<bool> used(mesh.vertex_count);
        for (const std::uint32_t v : mesh.indices) used[v] = true;
        unused += static_cast<std::size_t>(std::ranges::count(used, false));
    }
    CHECK_MESSAGE(extra > 100, "the meshes have non-manifold vertices");
    CHECK(unused > 10);
}

TEST_CASE("lr files with seams of several blocks are decoded") {
    for (const Format format : test::kFormats) {
        // A large mesh has several groups of blocks.
        const bool large = format == Format::packed && !test::kSanitized;
        const CutMesh cut = test::cut_mesh(generate("blob", large ? 20000 : 2000).value(), large ? 1 : 2, 7);
        check_file(cut, make_cut(cut, large, format));
    }
}

TEST_CASE("quantized attributes of copies stay within their error, and copies share one position") {
    const CutMesh cut = {with_numbers(small_cut().mesh), small_cut().surface};
    for (const Format format : test::kFormats) {
        LrFile file = make_cut(cut, true, format);
        const auto report = compress_attributes(file, {.positions = 9, .normals = 8, .texcoords = 8});
        REQUIRE_MESSAGE(report, report.error().message);
        CHECK((*report)[0].largest_error > 0);
        CHECK((*report)[1].largest_error > 0);
        const Result<LrFile> read = parse_lr(serialize_lr(file));
        REQUIRE_MESSAGE(read, read.error().message);
        const Result<Mesh> back = decode_lr_original_order(*read);
        REQUIRE(back);
        CHECK(back->indices == test::indices_of_kept(cut.mesh));
        CHECK(agrees(back->attributes[0], cut.surface));
        for (std::size_t a = 0; a < cut.mesh.attributes.size(); ++a) {
            const Attribute &before = cut.mesh.attributes[a], &after = back->attributes[a];
            CAPTURE(before.name);
            CHECK(before.v_up == after.v_up);
            if ((*report)[a].largest_error == 0) {
                CHECK(before.data == after.data);
                continue;
            }
            std::vector<float> x(before.data.size() / 4), y(x.size());
            std::memcpy(x.data(), before.data.data(), before.data.size());
            std::memcpy(y.data(), after.data.data(), after.data.size());
            double largest = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                largest = std::max(largest, std::abs(static_cast<double>(x[i]) - static_cast<double>(y[i])));
            }
            CHECK(largest <= 1.000001 * (*report)[a].largest_error);
        }
    }
}

TEST_CASE("every truncation and every flipped bit of an lr file with seams is refused") {
    const std::vector<std::byte> good = serialize_lr(make_cut(small_cut(), true, Format::packed));
    REQUIRE(parse_lr(good));
    test::for_each_cut(good, [](auto cut) { CHECK_FALSE(parse_lr(cut)); });
    test::for_each_flip(
        good, [](const auto& bad, std::size_t) { CHECK_FALSE(parse_lr(bad)); }, 1);
}

TEST_CASE("lr files with bad seams and valid checksums are refused") {
    LrFile file = make_cut(small_cut(), true, Format::packed);
    REQUIRE(file.attributes[1].per_copy);
    REQUIRE_FALSE(file.attributes.back().per_copy);
    SUBCASE("positions stored per copy") {
        file.attributes[0].per_copy = true;
        file.attributes[0].data.resize(std::size_t{12} * file.copy_count);
    }
    SUBCASE("an attribute per copy with the flag of one per vertex") {
        file.attributes[1].per_copy = false;
    }
    SUBCASE("an attribute per vertex with the flag of one per copy") {
        file.attributes.back().per_copy = true;
    }
    SUBCASE("vertex streams with the wrong flag") {
        REQUIRE(compress_attributes(file));
        file.attributes[1].per_copy = false;
    }
    SUBCASE("seams without copies") {
        file.copy_count = 0;
    }
    SUBCASE("copies without seams") {
        file.seams.clear();
    }
    SUBCASE("attributes per copy, but neither copies nor seams") {
        file.seams.clear();
        file.copy_count = 0;
        file.vertex_order.clear();
    }
    SUBCASE("one copy too many") {
        ++file.copy_count;
        for (LrAttribute& attribute : file.attributes) {
            if (attribute.per_copy) attribute.data.resize(attribute.stride() * file.copy_count);
        }
        file.vertex_order.push_back(file.copy_count - 1);
    }
    SUBCASE("fewer copies than vertices") {
        file.copy_count = file.vertex_count - 1;
    }
    SUBCASE("seams of fewer words") {
        file.seams.pop_back();
        mend(file.seams);
    }
    SUBCASE("seams of one word too many") {
        file.seams.push_back(0);
        mend(file.seams);
    }
    SUBCASE("seams of a mesh with fewer triangles") {
        file.seams = make_cut(test::cut_mesh(test::random_gluing(40, 70, 5), 2, 1), false, Format::packed).seams;
    }
    SUBCASE("seams for slots in another order") {
        file.seams = make_cut(small_cut(), false, Format::lean).seams;
    }
    SUBCASE("a vertex order of vertices instead of copies") {
        file.vertex_order.resize(file.vertex_count);
    }
    SUBCASE("a copy twice in the order") {
        file.vertex_order[0] = file.vertex_order[1];
    }
    SUBCASE("a corner order of the wrong length") {
        file.corner_order.pop_back();
    }
    CHECK_FALSE(parse_lr(serialize_lr(file)));
}

TEST_CASE("a surface in which an unused vertex is a copy of another is refused") {
    // Vertex 3 has no corner, but is a copy of 2.
    CutMesh cut{test::make_mesh({0, 1, 2}, 4), {3, {0, 1, 2, 2}}};
    Result<LrFile> file =
        make_lr_file(cut.mesh, cut.surface, test::encode_as(Format::lean, surface_mesh(cut.mesh, cut.surface)), true);
    REQUIRE_FALSE(file);
    CHECK(file.error().code == ErrorCode::invalid_argument);
}

TEST_CASE("a file with copies has one section of seams, at any place") {
    const std::vector<std::byte> good = serialize_lr(make_cut(small_cut(), true, Format::packed));
    // Section 1 is the seams. parse_lr and view_lr_file must accept the same files.
    const auto accepts = [&](const std::function<void(detail::FileHeader&, std::vector<Part>&)>& change) {
        const std::vector<std::byte> bytes =
            with_parts(good, [&](detail::FileHeader& header, std::vector<Part>& parts) {
                REQUIRE(parts[1].entry.kind == detail::kSeams);
                change(header, parts);
            });
        const bool parsed = parse_lr(bytes).has_value();
        CHECK(parsed == view_lr_file(bytes).has_value());
        return parsed;
    };
    const Part empty{{detail::kSeams, 0, 0, 0, 0, 0, 0}, {}};
    SUBCASE("the section may be at any place") {
        CHECK(accepts([](auto&, auto&) {}));
        CHECK(accepts([](auto&, auto& parts) { std::swap(parts[0], parts[1]); }));
        CHECK(accepts([](auto&, auto& parts) { std::rotate(parts.begin(), parts.begin() + 2, parts.end()); }));
    }
    SUBCASE("an empty section beside it is accepted") {
        CHECK(accepts([&](auto&, auto& parts) { parts.push_back(empty); }));
        CHECK(accepts([&](auto&, auto& parts) { parts.insert(parts.begin(), empty); }));
    }
    SUBCASE("a second section is refused") {
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts.push_back(Part(parts[1])); }));
    }
    SUBCASE("a second, empty connectivity is refused") {
        CHECK_FALSE(accepts([](auto&, auto& parts) {
            parts.insert(parts.begin(), Part(parts[0]));
            parts[0].contents.clear();
        }));
    }
    SUBCASE("a missing or empty section is refused") {
        CHECK_FALSE(accepts([&](auto&, auto& parts) { parts[1] = empty; }));
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts.erase(parts.begin() + 1); }));
    }
    SUBCASE("a section with a layout, a name, a coding or a byte less is refused") {
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts[1].entry.layout = detail::kPerCopy; }));
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts[1].entry.name_length = 1; }));
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts[1].entry.coding = 1; }));
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts[1].contents.pop_back(); }));
    }
    SUBCASE("fewer copies than vertices, another version, or an unknown layout bit is refused") {
        CHECK_FALSE(accepts([](auto& header, auto&) { header.copies = header.vertices - 1; }));
        CHECK_FALSE(accepts([](auto& header, auto&) { header.version = 3; }));
        CHECK_FALSE(accepts([](auto&, auto& parts) { parts[2].entry.layout |= 1U << 19; }));
    }
}

TEST_CASE("damaged seams that are accepted decode to a mesh that can be encoded again") {
    test::SplitMix64 random(3);
    std::uint32_t accepted = 0;
    for (const Format format : test::kFormats) {
        for (const std::uint32_t charting : {0U, 2U, 4U}) {
            CutMesh cut = test::cut_mesh(test::random_gluing(60, 120, 5), charting, 1);
            if (!cut.surface.has_seams()) cut = test::cut_mesh(test::random_gluing(60, 120, 5), 1, 1);
            const LrFile file = make_cut(cut, false, format);
            for (std::uint32_t n = 0; n < (test::kSanitized ? 60 : 300); ++n) {
                LrFile changed = file;
                std::uint32_t& word =
                    changed.seams[2 + random.below(static_cast<std::uint32_t>(file.seams.size()) - 2)];
                word ^= 1U << random.below(32);
                mend(changed.seams);
                // The file's attributes get the number of copies of the damaged section.
                const Result<StreamView> stream = view_stream(file.words);
                const Result<SeamView> seams = view_seams(changed.seams, stream->slots(), stream->vertices());
                if (!seams || seams->copies > 1000) continue;
                changed.copy_count = seams->copies;
                for (LrAttribute& attribute : changed.attributes) {
                    if (attribute.per_copy) attribute.data.resize(attribute.stride() * changed.copy_count);
                }
                const Result<LrFile> read = parse_lr(serialize_lr(changed));
                if (!read) continue;
                ++accepted;
                CAPTURE(n);
                Surface surface;
                const Result<Mesh> mesh = decode_lr(*read, &surface);
                REQUIRE(mesh);
                for (const std::uint32_t v : mesh->indices) REQUIRE(v < mesh->vertex_count);
                REQUIRE(agrees(mesh->attributes[0], surface));
                const Mesh joined = surface_mesh(*mesh, surface), before = surface_mesh(cut.mesh, cut.surface);
                test::ValueNumbers numbers;
                REQUIRE(test::triangles_by_values(joined, numbers) == test::triangles_by_values(before, numbers));
                check_file({*mesh, surface}, make_cut({*mesh, surface}, true, format));
            }
        }
    }
    CHECK(accepted > 50);
}

TEST_CASE("golden bytes: lr files with seams have the stored bytes, and these decode to the mesh") {
    const CutMesh cut = small_cut();
    for (const Format format : {Format::packed, Format::lr}) {
        const std::vector<std::byte> bytes =
            test::check_golden(std::string(GOLDEN_FOLDER) + "/file-seams-" + std::string(name_of(format)) + ".hex",
                               serialize_lr(make_cut(cut, true, format)));
        const Result<LrFile> read = parse_lr(bytes);
        REQUIRE_MESSAGE(read, read.error().message);
        test::check_same_mesh(decode_lr_original_order(*read), cut.mesh);
    }
}
