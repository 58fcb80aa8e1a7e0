#include "tests/fuzz/use.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>

#include "lacedring/mesh_files.hpp"
#include "lacedring/streams.hpp"
#include "lrcore/codec/packed/packed_format.h"
#include "lrio/mesh/write_formats.h"
#include "lrlab/paper/offsets.h"

namespace lacedring::fuzz {
namespace {

/// An array of exactly `size` words, so that a sanitizer reports writes behind it.
struct ExactWords {
    explicit ExactWords(std::size_t count) : data(new std::uint32_t[count]()), size(count) {}
    std::span<std::uint32_t> span() const { return {data.get(), size}; }

    std::unique_ptr<std::uint32_t[]> data;
    std::size_t size;
};

template <class Real>
bool all_finite(std::span<const std::byte> data) {
    for (std::size_t i = 0; i + sizeof(Real) <= data.size(); i += sizeof(Real)) {
        Real value{};
        std::memcpy(&value, data.data() + i, sizeof value);
        if (!std::isfinite(value)) return false;
    }
    return true;
}

void check_triangles(std::span<const std::uint32_t> indices, std::uint32_t vertices) {
    REQUIRE(indices.size() % 3 == 0);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        REQUIRE(a < vertices && b < vertices && c < vertices);
        REQUIRE(a != b && b != c && c != a);
    }
}

template <class View>
std::vector<std::uint32_t> use_tables(const LrStreamView<View>& stream) {
    const Operators<View> ops(stream.view);
    std::vector<bool> seen(stream.view.ring_vertices);
    for (std::uint32_t v = 0; v < stream.view.ring_vertices; ++v) {
        const std::uint32_t n = ops.ring_next(v);
        REQUIRE(n < stream.view.ring_vertices && !seen[n]);
        REQUIRE(ops.ring_previous(n) == v);
        seen[n] = true;
    }
    // A header may have any number of unused vertices; three are enough to test.
    const std::uint32_t vertices = std::min(stream.view.vertices, stream.view.used_vertices() + 3);
    check_operators(ops, stream.view.triangle_numbers(), vertices);
    for (const std::uint32_t v : stream.copies) REQUIRE(v < stream.view.vertices);
    std::vector<std::uint32_t> indices = decode_lr(stream);
    for (const std::uint32_t v : indices) REQUIRE(v < stream.view.vertices);
    if (stream.copies.empty())
        check_triangles(indices, stream.view.vertices);  // a triangle may have two copies of a vertex
    return indices;
}

Result<Mesh> write_and_read(const Mesh& mesh, MeshFormat format) {
    detail::Bytes head, body;
    WriteNotes notes;
    if (format == MeshFormat::gltf) {
        if (const auto made = detail::make_glb(mesh, head, body, notes); !made) return made.error();
    } else if (format == MeshFormat::ply) {
        detail::make_ply(mesh, head, body);
    } else {
        detail::make_obj(mesh, body, notes);
    }
    for (const std::string& note : notes) check_message({ErrorCode::malformed, note});
    head.insert(head.end(), body.begin(), body.end());
    return read_mesh(head, {}, {.format = format});
}

const Attribute* floats(const Mesh& mesh, std::string_view name, std::size_t components) {
    const Attribute* attribute = find_attribute(mesh, name);
    if (attribute == nullptr || attribute->components != components) return nullptr;
    return attribute->type == ComponentType::f32 || attribute->type == ComponentType::f64 ? attribute : nullptr;
}

double component(const Attribute& attribute, std::size_t vertex, std::size_t i) {
    const std::byte* from = attribute.data.data() + vertex * attribute.stride();
    if (attribute.type == ComponentType::f64) {
        double wide = 0;
        std::memcpy(&wide, from + i * sizeof wide, sizeof wide);
        return wide;
    }
    float narrow = 0;
    std::memcpy(&narrow, from + i * sizeof narrow, sizeof narrow);
    return static_cast<double>(narrow);
}

/// Changes the values of a vertex to those that a writer stores.
using Rewrite = std::function<void(const Attribute&, std::span<double>)>;

/// glTF has only finite numbers, and v downwards; OBJ has v upwards.
void to_gltf(const Attribute& attribute, std::span<double> values) {
    for (double& value : values) {
        if (!std::isfinite(static_cast<float>(value))) value = 0;
    }
    if (attribute.v_up) values[1] = static_cast<double>(1.0F - static_cast<float>(values[1]));
}
void to_obj(const Attribute& attribute, std::span<double> values) {
    if (attribute.name != "TEXCOORD_0" || attribute.v_up) return;
    values[1] = attribute.type == ComponentType::f32 ? static_cast<double>(1.0F - static_cast<float>(values[1]))
                                                     : 1.0 - values[1];
}

/// Checks that `back` has, at every corner, the rewritten values of `mesh` as floats. All NaNs are equal, and doubles
/// that were written as decimals may differ in the last bit.
void check_corners(const Mesh& mesh, const Mesh& back, std::string_view name, std::size_t components,
                   const Rewrite& rewrite) {
    const Attribute* want = floats(mesh, name, components);
    if (want == nullptr) return;
    const Attribute* got = floats(back, name, components);
    REQUIRE(got != nullptr);
    REQUIRE(back.indices.size() == mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        double values[3];
        for (std::size_t k = 0; k < components; ++k) values[k] = component(*want, mesh.indices[i], k);
        rewrite(*want, std::span(values, components));
        for (std::size_t k = 0; k < components; ++k) {
            const double a = values[k], b = component(*got, back.indices[i], k);
            const auto x = static_cast<float>(std::clamp(a, -3.5e38, 3.5e38)), y = static_cast<float>(b);
            const bool exact = std::memcmp(&x, &y, sizeof x) == 0 || (std::isnan(a) && std::isnan(b)) ||
                               (std::isinf(x) && std::isinf(y) && std::signbit(x) == std::signbit(y));
            const bool near = want->type == ComponentType::f64 && std::nextafter(x, y) == y;
            REQUIRE(exact || near);
        }
    }
}

/// Checks that normals have unit length, and are unchanged if they had it before.
void check_gltf_normals(const Mesh& mesh, const Mesh& back) {
    const Attribute *want = floats(mesh, "NORMAL", 3), *got = floats(back, "NORMAL", 3);
    if (want == nullptr) return;
    REQUIRE(got != nullptr);
    for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
        double before = 0, after = 0, change = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = static_cast<double>(static_cast<float>(component(*want, v, k)));
            const double b = component(*got, v, k);
            before += a * a;
            after += b * b;
            change += (a - b) * (a - b);
        }
        REQUIRE(std::abs(std::sqrt(after) - 1) < 0.0051);
        if (std::abs(std::sqrt(before) - 1) < 0.0049) REQUIRE(change == 0);
    }
}

}  // namespace

void check_message(const Error& error) {
    REQUIRE(!error.message.empty() && error.message.size() < 1000);
    REQUIRE(std::all_of(error.message.begin(), error.message.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

void check_mesh(const Mesh& mesh) {
    REQUIRE(!mesh.indices.empty() && mesh.indices.size() % 3 == 0);
    for (const std::uint32_t v : mesh.indices) REQUIRE(v < mesh.vertex_count);
    REQUIRE(!mesh.attributes.empty());
    for (const Attribute& attribute : mesh.attributes) {
        REQUIRE(size_of(attribute.type) != 0 && attribute.components != 0);
        REQUIRE(attribute.data.size() == attribute.stride() * mesh.vertex_count);
    }
    const Attribute& position = mesh.attributes.front();
    REQUIRE(position.name == "POSITION" && position.components == 3);
    REQUIRE(position.type == ComponentType::f32
                ? all_finite<float>(position.data)
                : position.type == ComponentType::f64 && all_finite<double>(position.data));
    REQUIRE(positions_f32(mesh).size() == std::size_t{3} * mesh.vertex_count);
    REQUIRE(normals_f32(mesh).size() == std::size_t{3} * mesh.vertex_count);
}

bool same_attributes(const Mesh& a, const Mesh& b) {
    return std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(),
                      [](const Attribute& x, const Attribute& y) {
                          return x.name == y.name && x.type == y.type && x.components == y.components &&
                                 x.normalized == y.normalized && x.data == y.data && x.v_up == y.v_up;
                      });
}

void check_writers(const Mesh& mesh) {
    if (mesh.triangle_count() > 2000 || mesh.vertex_count > 5000) return;
    const Result<Mesh> ply = write_and_read(mesh, MeshFormat::ply);
    REQUIRE(ply);
    REQUIRE(ply->vertex_count == mesh.vertex_count && ply->indices == mesh.indices);
    REQUIRE(same_attributes(*ply, mesh));
    const std::vector<float> positions = positions_f32(mesh);
    const bool finite = all_finite<float>(std::as_bytes(std::span(positions)));  // rounding may overflow
    const Result<Mesh> glb = write_and_read(mesh, MeshFormat::gltf);
    REQUIRE(glb.has_value() == finite);
    const Result<Mesh> obj = write_and_read(mesh, MeshFormat::obj);
    REQUIRE(obj.has_value() == finite);
    if (!finite) return;
    REQUIRE(glb->vertex_count == mesh.vertex_count && glb->indices == mesh.indices);
    check_mesh(*glb);
    check_corners(mesh, *glb, "POSITION", 3, [](const Attribute&, std::span<double>) {});
    check_corners(mesh, *glb, "TEXCOORD_0", 2, to_gltf);
    check_gltf_normals(mesh, *glb);
    check_mesh(*obj);
    for (const auto& [name, components] :
         {std::pair("POSITION", 3U), std::pair("NORMAL", 3U), std::pair("TEXCOORD_0", 2U)}) {
        check_corners(mesh, *obj, name, components, to_obj);
    }
}

std::vector<std::uint32_t> use_lean(const LeanView& view) {
    const ExactWords decoded(std::size_t{3} * view.slots());
    decode_lean(view, decoded.span());
    std::vector<std::uint32_t> indices;
    for (std::uint32_t slot = 0; slot < view.slots(); ++slot) {
        const auto triangle = decode_lean_slot(view, slot);
        const auto whole = decoded.span().subspan(std::size_t{3} * slot, 3);
        REQUIRE(std::equal(whole.begin(), whole.end(), triangle.v));
        for (const std::uint32_t v : triangle.v) REQUIRE(v < view.vertices);
        if (!triangle.degenerate()) indices.insert(indices.end(), triangle.v, triangle.v + 3);
    }
    check_triangles(indices, view.vertices);
    REQUIRE(indices.size() == std::size_t{3} * view.triangles);
    return indices;
}

std::vector<std::uint32_t> use_packed(const PackedView& view) {
    const ExactWords decoded(std::size_t{3} * view.triangles);
    decode_packed(view, decoded.span());
    check_triangles(decoded.span(), view.vertices);
    const ExactWords threaded(decoded.size);
    decode_packed(view, threaded.span(), 3);
    REQUIRE(std::ranges::equal(decoded.span(), threaded.span()));
    for (std::uint32_t block = 0; block < view.blocks(); ++block) {
        const std::uint32_t first = block * LR_PACKED_BLOCK;
        const ExactWords alone(std::size_t{3} * std::min(view.triangles - first, LR_PACKED_BLOCK));
        decode_packed_block(view, block, alone.span());
        REQUIRE(std::ranges::equal(alone.span(), decoded.span().subspan(std::size_t{3} * first, alone.size)));
    }
    const std::uint32_t step = view.triangles / 512 + 1;  // decoding one costs up to a block
    for (std::uint32_t t = 0; t < view.triangles; t += step) {
        const auto triangle = decode_packed_triangle(view, t);
        const auto whole = decoded.span().subspan(std::size_t{3} * t, 3);
        REQUIRE(std::equal(whole.begin(), whole.end(), triangle.v));
    }
    return {decoded.span().begin(), decoded.span().end()};
}

std::vector<std::uint32_t> use_lr(const LrStreamView<LrView>& stream) {
    const OffsetCounts offsets = count_offsets(stream.view);
    REQUIRE(offsets.t0 == stream.view.vo.size() / 6);
    return use_tables(stream);
}

std::vector<std::uint32_t> use_lr(const LrStreamView<CompactLrView>& stream) {
    REQUIRE(count_long_tips(stream.view) <= 2 * std::uint64_t{stream.view.ring_vertices});
    return use_tables(stream);
}

void use_vertices(const VertexView& view) {
    constexpr std::size_t kMostDecoded = 64 << 20, kMostEncoded = 1 << 16;  // bytes; encoding is slow
    const std::size_t size = view.decoded_bytes();
    if (size > kMostDecoded) return;
    const auto decoded = std::make_unique<std::byte[]>(size);
    const std::span<std::byte> values(decoded.get(), size);
    decode_vertices(view, values);
    std::vector<std::byte> at_once(size);
    REQUIRE(decode_vertices_checked(view, at_once) && std::ranges::equal(at_once, values));
    const bool lossless = view.mapping != VertexMapping::lattice && view.mapping != VertexMapping::octahedral;
    REQUIRE(lossless || all_finite<float>(values));
    const auto decode_block = [&](std::uint32_t block) {
        ExactWords out(std::size_t{view.integers} * std::min(view.vertices - block * kVertexBlock, kVertexBlock));
        decode_vertex_block(view, block, out.span());
        return out;
    };
    std::vector<ExactWords> blocks;
    for (std::uint32_t block = 0; block < view.blocks(); ++block) blocks.push_back(decode_block(block));
    for (std::uint32_t block = view.blocks(); block-- > 0;) {
        REQUIRE(std::ranges::equal(decode_block(block).span(), blocks[block].span()));
    }
    if (size > kMostEncoded) return;
    const Result<EncodedVertices> encoded = encode_vertices({view.type, view.components, view.normalized, values});
    REQUIRE(encoded && encoded->largest_error == 0);
    const ExactWords words(encoded->words.size());
    std::ranges::copy(encoded->words, words.data.get());
    const Result<VertexView> again = validate_vertices(words.span());
    REQUIRE(again && again->vertices == view.vertices && again->largest_error == 0);
    REQUIRE(again->type == view.type && again->components == view.components && again->normalized == view.normalized);
    const auto decoded_again = std::make_unique<std::byte[]>(size);
    decode_vertices(*again, {decoded_again.get(), size});
    REQUIRE(std::ranges::equal(values, std::span(decoded_again.get(), size)));
}

void use_seams(const SeamView& view, std::span<const std::uint32_t> triangles) {
    if (view.vertices > 1U << 16) return;
    const ExactWords copies(triangles.size()), first(std::size_t{view.vertices} + 1), vertices(view.copies);
    decode_seams(view, triangles, copies.span());
    first_copies(view, first.span());
    copy_vertices(view, triangles, vertices.span());
    std::vector<std::uint32_t> copies_at_once(triangles.size()), vertices_at_once;
    REQUIRE(decode_seams_checked(view.words, triangles, view.vertices, copies_at_once, vertices_at_once));
    REQUIRE(std::ranges::equal(copies_at_once, copies.span()) && std::ranges::equal(vertices_at_once, vertices.span()));
    REQUIRE(first.span().front() == 0 && first.span().back() == view.homes);
    REQUIRE(std::ranges::adjacent_find(first.span(), std::greater_equal()) == first.span().end());
    for (std::size_t c = 0; c < triangles.size(); ++c) {
        const std::uint32_t v = triangles[c], copy = copies.span()[c];
        if (v == UINT32_MAX) {  // slot without a triangle
            REQUIRE(copy == UINT32_MAX);
            continue;
        }
        REQUIRE(copy < view.copies && vertices.span()[copy] == v);
        REQUIRE(copy >= view.homes || (first.span()[v] <= copy && copy < first.span()[v + 1]));
    }
    for (std::uint32_t block = view.blocks(); block-- > 0;) {
        const std::size_t begin = std::size_t{3} * kSeamBlock * block;
        const ExactWords alone(std::min<std::size_t>(triangles.size() - begin, 3 * kSeamBlock));
        decode_seam_block(view, block, triangles.subspan(begin, alone.size), alone.span());
        REQUIRE(std::ranges::equal(alone.span(), copies.span().subspan(begin, alone.size)));
    }
    // Encoding takes long: only one section in eight, chosen by the checksum.
    if (view.words[1] % 8 != 0) return;
    const Result<EncodedSeams> encoded = encode_seams(triangles, view.vertices, copies.span());
    REQUIRE(encoded);
    const Result<SeamView> again = validate_seams(encoded->words, triangles, view.vertices);
    REQUIRE(again && again->copies == encoded->copy_order.size());
    const ExactWords decoded(triangles.size());
    decode_seams(*again, triangles, decoded.span());
    for (std::size_t c = 0; c < triangles.size(); ++c) {
        REQUIRE(triangles[c] == UINT32_MAX || encoded->copy_order[decoded.span()[c]] == copies.span()[c]);
    }
}

}  // namespace lacedring::fuzz
