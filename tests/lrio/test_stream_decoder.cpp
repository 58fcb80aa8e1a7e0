// Compares scene streams, decoded to sets and parts, with the mesh that decode_lr returns.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "lrio/scene/part_codes.h"
#include "lrio/scene/stream_decoder.h"
#include "tests/lrio/lr_files.h"
#include "tests/support/capture.h"
#include "tests/support/cut_mesh.h"
#include "tests/support/cuts.h"
#include "tests/support/damage.h"
#include "tests/support/shapes.h"

using namespace lacedring;
using detail::StreamDecoder;

namespace {

using Rows = std::vector<std::byte>;

/// A mesh whose vertices belong to sets and whose triangles belong to parts; a part uses the vertices of one set.
struct Grouped {
    test::CutMesh cut;
    std::vector<std::uint32_t> set_of;       ///< by vertex
    std::vector<std::uint32_t> part_of;      ///< by triangle
    std::vector<std::uint32_t> set_of_part;  ///< by part
    std::vector<std::uint32_t> vertices;     ///< by set: its number of vertices

    StreamDecoder::Said said() const { return {set_of_part, vertices}; }
    StreamDecoder::Said unsaid() const { return {set_of_part, std::vector(vertices.size(), UINT32_MAX)}; }
};

/// Distributes the connected components of a mesh to at most `sets` sets, and the triangles of each set to at most
/// `parts` parts. Vertices are ordered by set. Without keep_order, degenerate triangles and unused vertices are left
/// out.
Grouped group_mesh(const test::CutMesh& whole, std::size_t sets, std::size_t parts, bool keep_order,
                   std::uint64_t seed) {
    const Mesh& mesh = whole.mesh;
    const auto& vertex_of = whole.surface.vertex_of;
    test::SplitMix64 random(seed);
    std::vector<std::uint32_t> root(mesh.vertex_count);
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    std::vector<bool> used(mesh.vertex_count, keep_order), kept(mesh.triangle_count());
    for (std::size_t t = 0; t < kept.size(); ++t) {
        const std::uint32_t* v = &mesh.indices[3 * t];
        const auto surface = [&](std::size_t k) { return vertex_of.empty() ? v[k] : vertex_of[v[k]]; };
        kept[t] = surface(0) != surface(1) && surface(1) != surface(2) && surface(2) != surface(0);
        for (std::size_t k = 0; k < 3 && (kept[t] || keep_order); ++k) {
            root[find(v[k])] = find(v[0]);
            used[v[k]] = true;
        }
    }
    // Each set needs a triangle: components with triangles are distributed first.
    std::vector<std::uint32_t> set_of_root(mesh.vertex_count, UINT32_MAX), set_of(mesh.vertex_count);
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < kept.size(); ++t) {
        std::uint32_t& set = set_of_root[find(mesh.indices[3 * t])];
        if (!kept[t] || set != UINT32_MAX) continue;
        set = count < sets ? count++ : random.below(count);
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        set_of[v] = set_of_root[find(v)] == UINT32_MAX ? 0 : set_of_root[find(v)];
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        if (used[v]) order.push_back(v);
    }
    std::ranges::stable_sort(order, {}, [&](std::uint32_t v) { return set_of[v]; });
    Grouped out;
    out.vertices.resize(count);
    std::vector<std::uint32_t> number(mesh.vertex_count, UINT32_MAX),
        surface_number(whole.surface.vertex_count, UINT32_MAX);
    Surface& surface = out.cut.surface;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        number[order[i]] = i;
        out.set_of.push_back(set_of[order[i]]);
        ++out.vertices[out.set_of.back()];
        std::uint32_t& at = surface_number[vertex_of.empty() ? order[i] : vertex_of[order[i]]];
        if (at == UINT32_MAX) at = surface.vertex_count++;
        if (!vertex_of.empty()) surface.vertex_of.push_back(at);
    }
    out.cut.mesh.vertex_count = static_cast<std::uint32_t>(order.size());
    out.cut.mesh.attributes = permute_attributes(mesh.attributes, order);
    std::vector<std::vector<std::uint32_t>> parts_of(count);
    for (std::size_t t = 0; t < kept.size(); ++t) {
        if (!kept[t] && !keep_order) continue;
        for (std::size_t k = 0; k < 3; ++k) out.cut.mesh.indices.push_back(number[mesh.indices[3 * t + k]]);
        std::vector<std::uint32_t>& of_set = parts_of[set_of[mesh.indices[3 * t]]];
        if (kept[t] && of_set.size() < parts) {
            out.part_of.push_back(static_cast<std::uint32_t>(out.set_of_part.size()));
            of_set.push_back(out.part_of.back());
            out.set_of_part.push_back(set_of[mesh.indices[3 * t]]);
        } else {
            out.part_of.push_back(of_set.empty() ? 0 : of_set[random.below(static_cast<std::uint32_t>(of_set.size()))]);
        }
    }
    return out;
}

/// A stream of the glTF extension: an .lr file, and part codes if there are several parts.
struct Stream {
    Rows file, parts;
    std::vector<std::uint32_t> part_of;  ///< by triangle that decode_lr or decode_lr_original_order returns
};

Stream encode_group(const Grouped& group, Format format, bool keep_order, std::uint32_t compression) {
    const auto& [mesh, surface] = group.cut;
    Encoded encoded = test::encode_as(format, surface_mesh(mesh, surface));
    Stream out;
    std::vector<std::uint32_t> order = encoded.triangle_order;
    for (const std::uint32_t t : order) out.part_of.push_back(group.part_of[t]);
    if (group.set_of_part.size() > 1) {
        const auto codes = detail::encode_part_codes(out.part_of);
        REQUIRE(codes);
        out.parts = *codes;
    }
    if (keep_order) {
        std::ranges::sort(order);
        for (std::size_t i = 0; i < order.size(); ++i) out.part_of[i] = group.part_of[order[i]];
    }
    Result<LrFile> file = make_lr_file(mesh, surface, std::move(encoded), keep_order);
    REQUIRE_MESSAGE(file, file.error().message);
    const AttributeBits lossy{.positions = 10, .normals = 8, .texcoords = 9, .colors = 8};
    if (compression > 0) REQUIRE(compress_attributes(*file, compression == 1 ? AttributeBits{} : lossy));
    out.file = serialize_lr(*file);
    return out;
}

/// Everything that a StreamDecoder decodes.
struct Sets {
    std::vector<std::vector<Rows>> values;  ///< by set and attribute
    std::vector<std::vector<std::uint32_t>> parts;
};

Sets decode_all(StreamDecoder& decoder, std::size_t sets) {
    Sets out{std::vector<std::vector<Rows>>(sets), std::vector<std::vector<std::uint32_t>>(decoder.parts())};
    for (std::size_t a = 0; a < decoder.attributes().size(); ++a) {
        const AttributeView& attribute = decoder.attributes()[a];
        std::vector<std::span<std::byte>> to;
        for (std::size_t s = 0; s < sets; ++s) {
            to.emplace_back(
                out.values[s].emplace_back(decoder.vertices(s) * size_of(attribute.type) * attribute.components));
        }
        const Result<void> good = decoder.decode_attribute(a, to);
        REQUIRE_MESSAGE(good, good.error().message);
    }
    std::vector<std::span<std::uint32_t>> to;
    for (std::size_t p = 0; p < out.parts.size(); ++p) {
        out.parts[p].resize(decoder.corners(p));
        to.emplace_back(out.parts[p]);
    }
    decoder.decode_parts(to);
    return out;
}

/// The bytes of all attributes of a vertex.
std::string row_of(const Mesh& mesh, std::uint32_t v) {
    std::string out;
    for (const Attribute& a : mesh.attributes) {
        out.append(reinterpret_cast<const char*>(a.data.data()) + v * a.stride(), a.stride());
    }
    return out;
}
std::string row_of(const StreamDecoder& decoder, const std::vector<Rows>& values, std::uint32_t v) {
    std::string out;
    for (std::size_t a = 0; a < values.size(); ++a) {
        const AttributeView& attribute = decoder.attributes()[a];
        const std::size_t stride = size_of(attribute.type) * attribute.components;
        out.append(reinterpret_cast<const char*>(values[a].data()) + v * stride, stride);
    }
    return out;
}

/// Checks that each part has its triangles of `mesh`, in order, and each set its vertices.
void check_sets(const Mesh& mesh, const Stream& stream, const Grouped& group, StreamDecoder& decoder, bool keep_order) {
    const Sets sets = decode_all(decoder, group.vertices.size());
    std::vector<std::uint32_t> set_of(mesh.vertex_count, UINT32_MAX), place(mesh.vertex_count), next(sets.parts.size());
    REQUIRE(mesh.triangle_count() == stream.part_of.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        INFO("a part has its triangles in order, and a vertex one number in one set");
        const std::uint32_t part = stream.part_of[i / 3], set = group.set_of_part[part], v = mesh.indices[i];
        REQUIRE(next[part] < sets.parts[part].size());
        const std::uint32_t element = sets.parts[part][next[part]++];
        REQUIRE(element < decoder.vertices(set));
        REQUIRE((set_of[v] == UINT32_MAX || (set_of[v] == set && place[v] == element)));
        set_of[v] = set;
        place[v] = element;
    }
    for (std::size_t p = 0; p < next.size(); ++p)
        REQUIRE_MESSAGE(next[p] == sets.parts[p].size(), "no other triangles");
    std::vector<std::uint32_t> count(group.vertices.size(), 0);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        INFO("a set has its vertices in order, with their values");
        const std::uint32_t set = keep_order ? group.set_of[v] : set_of[v];
        REQUIRE(set != UINT32_MAX);
        if (set_of[v] != UINT32_MAX) REQUIRE(place[v] == count[set]);
        REQUIRE(row_of(mesh, v) == row_of(decoder, sets.values[set], count[set]++));
    }
    for (std::size_t s = 0; s < count.size(); ++s)
        REQUIRE_MESSAGE(count[s] == decoder.vertices(s), "no other vertices");
}

void check_stream(const Grouped& group, Format format, bool keep_order, std::uint32_t compression) {
    const Stream stream = encode_group(group, format, keep_order, compression);
    const Result<LrFile> file = parse_lr(stream.file);
    REQUIRE_MESSAGE(file, file.error().message);
    const Result<Mesh> mesh = keep_order ? decode_lr_original_order(*file) : decode_lr(*file);
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    if (keep_order && compression < 2) test::check_same_mesh(mesh, group.cut.mesh);
    Result<StreamDecoder> decoder =
        StreamDecoder::open(stream.file, stream.parts, keep_order ? group.said() : group.unsaid());
    REQUIRE_MESSAGE(decoder, decoder.error().message);
    check_sets(*mesh, stream, group, *decoder, keep_order);
    StreamDecoder::Said said = group.said();
    CHECK(StreamDecoder::open(stream.file, stream.parts, said));
    if (keep_order) CHECK_FALSE(StreamDecoder::open(stream.file, stream.parts, group.unsaid()));
    said.vertices.back() += 1;
    CHECK_FALSE_MESSAGE(StreamDecoder::open(stream.file, stream.parts, said), "a vertex too many");
    said.vertices[0] -= 1;
    if (said.vertices.size() > 1) {
        // The sum of vertices is right, but a set's range is wrong. It is refused if a triangle shows it; with
        // keep_order the vertices may be unused.
        const bool refused = !StreamDecoder::open(stream.file, stream.parts, said);
        CHECK((refused || keep_order));
    }
}

bool has_triangles(const test::CutMesh& cut) {
    return !test::oriented_triangles(surface_mesh(cut.mesh, cut.surface).indices).empty();
}

Grouped two_sets(bool keep_order) {
    test::CutMesh cut = test::cut_mesh(test::random_gluing(40, 80, 5), 1, 1);
    return group_mesh(cut, 2, 2, keep_order, 1);
}

std::string refusal(const Stream& stream, const StreamDecoder::Said& said) {
    const auto decoder = StreamDecoder::open(stream.file, stream.parts, said);
    if (decoder) return "";
    CHECK(decoder.error().code == ErrorCode::malformed);
    return decoder.error().message;
}

}  // namespace

TEST_CASE("scene streams decode to the triangles of each part and the values of each set") {
    std::uint64_t seed = 0;
    std::size_t several_sets = 0, several_parts = 0;
    for (const auto& [name, mesh] : test::named_meshes()) {
        if (mesh.triangle_count() > 150) continue;
        CAPTURE_COPY(name);
        for (const std::uint32_t how : {0U, 1U, 2U, 3U, 4U}) {
            ++seed;
            CAPTURE(seed);
            const test::CutMesh cut =
                how == 0 ? test::CutMesh{mesh, {mesh.vertex_count, {}}} : test::cut_mesh(mesh, how, seed);
            if (!has_triangles(cut)) continue;
            for (const bool keep_order : {false, true}) {
                CAPTURE(keep_order);
                const Grouped group = group_mesh(cut, 1 + seed % 3 * 2, 1 + seed / 3 % 2 * 3, keep_order, seed);
                several_sets += group.vertices.size() > 1 ? 1 : 0;
                several_parts += group.set_of_part.size() > 1 ? 1 : 0;
                const Format format = test::kFormats[(seed + (keep_order ? 1 : 0)) % 4];
                CAPTURE(std::string(name_of(format)));
                check_stream(group, format, keep_order, static_cast<std::uint32_t>(seed % 3));
            }
        }
    }
    CHECK(several_sets > 50);
    CHECK(several_parts > 100);
}

TEST_CASE("large scene streams decode to the triangles of each part and the values of each set") {
    const test::CutMesh whole = {test::random_gluing(4000, 8000, 3), {4000, {}}};
    const test::CutMesh cut = test::cut_mesh(whole.mesh, 1, 3);
    for (const test::CutMesh* mesh : {&whole, &cut}) {
        for (const std::size_t parts : {1U, 100U}) {
            const Grouped group = group_mesh(*mesh, parts, parts, false, 7);
            check_stream(group, Format::packed, false, 2);
            check_stream(group, Format::lean, false, 1);
        }
    }
}

TEST_CASE("sets and parts that differ from the stream are refused") {
    const Grouped group = two_sets(false);
    REQUIRE(group.vertices.size() == 2);
    REQUIRE(group.set_of_part.size() == 4);
    for (const Format format : test::kFormats) {
        CAPTURE(std::string(name_of(format)));
        const Stream stream = encode_group(group, format, false, 1);
        CHECK(refusal(stream, group.unsaid()).empty());
        const auto refuses = [&](const auto& change) {
            StreamDecoder::Said said = group.unsaid();
            change(said);
            return !refusal(stream, said).empty();
        };
        CHECK_MESSAGE(refuses([](auto& said) { said.set_of_part[0] = 1 - said.set_of_part[0]; }),
                      "a vertex of two sets");
        CHECK(refuses([](auto& said) { said.set_of_part.push_back(0); }));
        CHECK(refuses([](auto& said) { said.set_of_part.pop_back(); }));
        CHECK(refuses([](auto& said) { said.vertices.push_back(1); }));
        CHECK_MESSAGE(refuses([](auto& said) { said = {{0}, {UINT32_MAX}}; }), "part codes for one part");
        CHECK_FALSE_MESSAGE(refusal({stream.file, {}, {}}, group.unsaid()).empty(), "no part codes");
        std::vector<std::uint32_t> parts = stream.part_of;
        parts.push_back(0);  // a triangle too many
        CHECK_FALSE(refusal({stream.file, detail::encode_part_codes(parts).value(), {}}, group.unsaid()).empty());
    }
    const Grouped ordered = two_sets(true);
    const Stream stream = encode_group(ordered, Format::packed, true, 1);
    CHECK(refusal(stream, ordered.said()).empty());
    StreamDecoder::Said said = ordered.said();
    std::swap(said.set_of_part.front(), said.set_of_part.back());
    CHECK_FALSE_MESSAGE(refusal(stream, said).empty(), "triangles with vertices of another set");
    said = ordered.said();
    said.vertices = {said.vertices[0] + said.vertices[1], UINT32_MAX};
    CHECK_FALSE(refusal(stream, said).empty());
}

TEST_CASE("the caller's check gets the file before it is decoded, and its error is returned") {
    const Grouped group = two_sets(false);
    const Stream stream = encode_group(group, Format::packed, false, 0);
    const auto refuse = [&](const LrFileView& view) -> Result<void> {
        CHECK(view.attributes.size() == group.cut.mesh.attributes.size());
        return Error{ErrorCode::memory_limit, "no room"};
    };
    const auto decoder = StreamDecoder::open(stream.file, stream.parts, group.unsaid(), refuse);
    REQUIRE_FALSE(decoder);
    CHECK(decoder.error().code == ErrorCode::memory_limit);
    CHECK(decoder.error().message == "no room");
}

TEST_CASE("cut and damaged scene streams are refused") {
    for (const bool keep_order : {false, true}) {
        const Grouped group = two_sets(keep_order);
        const Stream stream = encode_group(group, Format::packed, keep_order, 2);
        REQUIRE(refusal(stream, group.said()).empty());
        const auto refused = [&](auto bytes) { return !StreamDecoder::open(bytes, stream.parts, group.said()); };
        test::for_each_cut(stream.file, [&](auto cut) { REQUIRE(refused(cut)); });
        test::for_each_flip(
            stream.file, [&](const Rows& bad, std::size_t) { REQUIRE(refused(std::span(bad))); }, 1);
    }
}

TEST_CASE("damaged vertex streams are refused when their values are decoded") {
    const Grouped group = two_sets(false);
    LrFile file = parse_lr(encode_group(group, Format::packed, false, 1).file).value();
    const Stream good = encode_group(group, Format::packed, false, 1);
    for (std::size_t a = 0; a < file.attributes.size(); ++a) {
        CAPTURE(a);
        LrFile bad = file;
        REQUIRE_FALSE(bad.attributes[a].words.empty());
        // The checksum of the vertex stream fails, those of the sections are valid.
        bad.attributes[a].words.back() ^= 1;
        bad.attributes[a].words[bad.attributes[a].words.size() - 3] ^= 1;
        const Rows bytes = serialize_lr(bad);
        auto decoder = StreamDecoder::open(bytes, good.parts, group.unsaid());
        REQUIRE_MESSAGE(decoder, decoder.error().message);
        const std::size_t stride = size_of(bad.attributes[a].type) * bad.attributes[a].components;
        std::vector<Rows> values(2);
        std::vector<std::span<std::byte>> to;
        for (std::size_t s = 0; s < 2; ++s) {
            values[s].resize(decoder->vertices(s) * stride);
            to.emplace_back(values[s]);
        }
        const Result<void> done = decoder->decode_attribute(a, to);
        REQUIRE_FALSE(done);
        CHECK(done.error().code == ErrorCode::malformed);
    }
}
