// The whole chain: mesh -> weld -> surface -> corner table -> rings -> every stream and file -> decode -> compare with
// the mesh. An input is an index list or a mesh file, followed by bytes of options.

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <unordered_map>
#include <utility>

#include "lacedring/lacedring.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/corner_table_c.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/strips.h"
#include "lrlab/rivals/winged_edge.h"
#include "tests/fuzz/streams.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

constexpr std::size_t kOptionBytes = 9;

struct Options {
    explicit Options(std::span<const std::byte> bytes) {
        for (std::size_t i = 0; i < kOptionBytes; ++i) byte[i] = std::to_integer<std::uint32_t>(bytes[i]);
    }

    Weld welding() const { return static_cast<Weld>(byte[0] % 3); }
    bool wart_skipping() const { return (byte[0] & 0x80) == 0; }
    bool keep_order() const { return (byte[0] & 0x60) != 0; }
    /// Half of the inputs have vertex streams in the file of one format, because encoding them is slow.
    bool compressed(Format format) const { return byte[4] % 8 == static_cast<std::uint32_t>(format); }
    bool one_per_shell() const { return (byte[0] & 0x10) != 0; }
    /// Returns whether vertices of one position are joined, as copies with their own attributes.
    bool joins() const { return (byte[8] & 0x40) == 0; }
    double tolerance() const { return std::array{0.0, 0.0, 1e-3, 3.0}[byte[6] >> 6 & 3]; }
    /// Zero bits run all steps; an input may leave out steps to run faster.
    bool wants(std::uint32_t step) const { return (byte[8] >> step & 1) == 0; }
    RingOptions ring(const CornerTable& table) const {
        RingOptions out{
            .seeds = 1 + byte[2] % 3, .random_seed = byte[4], .k = byte[1], .one_per_shell = one_per_shell()};
        const CornerId start{byte[5]};
        if (start.value < table.corners.size() && !table.degenerate(triangle(start))) out.start = start;
        return out;
    }
    OptimizeOptions optimize(const RingCost& cost) const {
        return {.cost = cost, .passes = byte[3] % 4, .random_seed = byte[4], .anneal = (byte[3] & 0x80) == 0};
    }

    std::array<std::uint32_t, kOptionBytes> byte{};
};

using Triangle = std::array<std::uint32_t, 3>;

/// The lexicographically smallest rotation.
Triangle rotated(const Triangle& t) {
    return std::min({t, Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[0], t[1]}});
}

/// The triangles that are not degenerate, with vertices replaced by id(vertex), rotated.
template <class Id>
std::vector<Triangle> triangles_of(std::span<const std::uint32_t> indices, Id id) {
    std::vector<Triangle> out;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (a != b && b != c && c != a) out.push_back(rotated({id(a), id(b), id(c)}));
    }
    return out;
}

std::vector<Triangle> triangles_of(std::span<const std::uint32_t> indices) {
    return triangles_of(indices, [](std::uint32_t v) { return v; });
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Numbers for the values of vertices in all attributes or the first ones; equal values of several meshes have one
/// number.
class ValueNumbers {
  public:
    /// `welding`: -0 equals 0 in POSITION.
    explicit ValueNumbers(std::size_t attributes = SIZE_MAX, bool welding = false)
        : attributes_(attributes), welding_(welding) {}

    std::uint32_t operator()(const Mesh& mesh, std::uint32_t v) {
        std::string value;
        for (std::size_t i = 0; i < std::min(attributes_, mesh.attributes.size()); ++i) {
            const Attribute& a = mesh.attributes[i];
            value.append(reinterpret_cast<const char*>(a.data.data()) + a.stride() * v, a.stride());
        }
        const std::size_t size = size_of(mesh.attributes[0].type);
        for (std::size_t end = size; welding_ && end <= 3 * size; end += size) {
            const bool zero = value.find_first_not_of('\0', end - size) == end - 1 && value[end - 1] == '\x80';
            if (zero) value[end - 1] = '\0';
        }
        return numbers_.try_emplace(std::move(value), static_cast<std::uint32_t>(numbers_.size())).first->second;
    }

    /// The sorted oriented triangles of the mesh, by the numbers of the values at their corners.
    std::vector<Triangle> triangles(const Mesh& mesh) {
        return sorted(triangles_of(mesh.indices, [&](std::uint32_t v) { return (*this)(mesh, v); }));
    }

  private:
    std::size_t attributes_;
    bool welding_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

Mesh welded(const Mesh& mesh, Weld mode) {
    Mesh out = weld(mesh, mode);
    REQUIRE(out.indices.size() == mesh.indices.size() && out.attributes.size() == mesh.attributes.size());
    if (mode == Weld::none) {
        REQUIRE(out.vertex_count == mesh.vertex_count && out.indices == mesh.indices && same_attributes(out, mesh));
        return out;
    }
    const std::size_t keys = mode == Weld::position ? 1 : SIZE_MAX;
    ValueNumbers values(keys, true), distinct(keys, true);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        REQUIRE(out.indices[i] < out.vertex_count);
        REQUIRE(values(out, out.indices[i]) == values(mesh, mesh.indices[i]));
    }
    for (std::uint32_t v = 0; v < out.vertex_count; ++v) REQUIRE(distinct(out, v) == v);
    return out;
}

/// A mesh and its surface.
struct Subject {
    Mesh mesh;
    Surface surface;
    Mesh whole;  ///< the surface, with positions only
};

/// Finds the surface of a mesh. Checks that it keeps every triangle and the values at every corner, except positions
/// that are moved within a tolerance.
Subject joined(Mesh mesh, const Options& options) {
    Subject out{std::move(mesh), {}, {}};
    out.surface.vertex_count = out.mesh.vertex_count;
    if (options.joins()) {
        const Mesh before = out.mesh;
        const double tolerance = options.tolerance();
        SurfaceReport report;
        out.surface = find_surface(out.mesh, tolerance, &report);
        REQUIRE(report.largest_move <= tolerance);
        move_to_surface(out.mesh, out.surface);
        REQUIRE(report.moved > 0 || same_attributes(out.mesh, before));
        if (!options.keep_order()) {
            const Mesh cut = std::exchange(out.mesh, merge_copies(out.mesh, out.surface));
            ValueNumbers values;
            for (std::size_t i = 0; i < cut.indices.size(); ++i) {
                REQUIRE(values(cut, cut.indices[i]) == values(out.mesh, out.mesh.indices[i]));
            }
        }
        ValueNumbers positions(1, true);
        for (std::size_t i = 0; i < before.indices.size() && tolerance == 0; ++i) {
            REQUIRE(positions(out.mesh, out.mesh.indices[i]) == positions(before, before.indices[i]));
        }
    }
    out.whole = surface_mesh(out.mesh, out.surface);
    REQUIRE(out.whole.vertex_count == out.surface.vertex_count);
    REQUIRE(triangles_of(out.whole.indices).size() == triangles_of(out.mesh.indices).size());
    ValueNumbers positions(1);
    for (std::size_t i = 0; i < out.mesh.indices.size(); ++i) {
        REQUIRE(positions(out.mesh, out.mesh.indices[i]) == positions(out.whole, out.whole.indices[i]));
    }
    return out;
}

void check_table(const Mesh& mesh, const CornerTable& table) {
    REQUIRE(check_corner_table(table).empty());
    REQUIRE(table.vertex_count == mesh.vertex_count && table.corners.size() == mesh.indices.size());
    for (std::uint32_t t = 0; t < table.triangle_count(); ++t) {
        const std::uint32_t second = table.flipped(TriangleId{t}) ? 2 : 1;
        REQUIRE(table.vertex(corner(TriangleId{t}, 0)).value == mesh.indices[3 * std::size_t{t}]);
        REQUIRE(table.vertex(corner(TriangleId{t}, second)).value == mesh.indices[3 * std::size_t{t} + 1]);
        REQUIRE(table.vertex(corner(TriangleId{t}, 3 - second)).value == mesh.indices[3 * std::size_t{t} + 2]);
    }
}

/// Checks that an encoded stream of the surface is valid and decodes to its triangles, and likewise the file made of
/// it.
void check_stream(const Subject& subject, Encoded encoded, const Options& options) {
    const Mesh &mesh = subject.mesh, &whole = subject.whole;
    const std::optional<Words> indices = use_stream(encoded.format, encoded.words);
    REQUIRE(indices);
    for (const std::uint32_t v : encoded.vertex_order) REQUIRE(v < whole.vertex_count);
    const std::vector<Triangle> got = triangles_of(*indices, [&](std::uint32_t v) { return encoded.vertex_order[v]; });
    REQUIRE(sorted(got) == sorted(triangles_of(whole.indices)));
    const Words& order = encoded.triangle_order;
    REQUIRE(order.size() == got.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        REQUIRE(order[i] < whole.triangle_count());
        const std::uint32_t* t = whole.indices.data() + 3 * std::size_t{order[i]};
        REQUIRE(got[i] == rotated({t[0], t[1], t[2]}));
    }

    const bool compressed = options.compressed(encoded.format);
    LrFile made = make_lr_file(mesh, subject.surface, std::move(encoded), options.keep_order()).value();
    REQUIRE((made.copy_count > 0) == subject.surface.has_seams());
    const Mesh before = decode_lr(made).value();
    REQUIRE(!compressed || compress_attributes(made));
    const std::vector<std::byte> bytes = serialize_lr(made);
    const Result<LrFile> file = parse_lr(bytes);
    REQUIRE(file);
    REQUIRE(serialize_lr(*file) == bytes);
    Surface surface;
    const Mesh decoded = decode_lr(*file, &surface).value();
    REQUIRE(surface.vertex_count == whole.vertex_count && surface.has_seams() == subject.surface.has_seams());
    REQUIRE(decoded.vertex_count == mesh.vertex_count && same_attributes(decoded, before));
    ValueNumbers values;
    REQUIRE(values.triangles(mesh) == values.triangles(decoded));
    const Result<Mesh> original = decode_lr_original_order(*file);
    if (!options.keep_order()) return;
    REQUIRE(original);
    REQUIRE(original->vertex_count == mesh.vertex_count && same_attributes(*original, mesh));
    std::vector<std::uint32_t> kept;  // the input's indices without degenerate triangles
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t* t = mesh.indices.data() + i;
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) kept.insert(kept.end(), t, t + 3);
    }
    REQUIRE(original->indices == kept);
}

void check_lean(const Subject& subject, const CornerTable& table, const Options& options) {
    Expansion expansion;
    Rings rings = expand_rings(table, options.ring(table), &expansion);
    REQUIRE(check_rings(table, rings).empty());
    REQUIRE(settling_steps(table, expansion).size() == table.triangle_count());
    rings = optimize_rings(table, std::move(rings), options.optimize(kLeanRingCost));
    REQUIRE(check_rings(table, rings).empty());
    Result<EncodedLean> lean = encode_lean(table, rings, {.wart_skipping = options.wart_skipping()});
    REQUIRE(lean);
    check_stream(subject, as_encoded(std::move(*lean)), options);
}

void check_packed(const Subject& subject, const CornerTable& table, const Options& options, PackedProfile profile) {
    Result<PackedChoice> packed =
        encode_smallest_packed(table, options.ring(table), options.optimize(kPackedRingCost), profile);
    REQUIRE(packed);
    check_stream(subject, as_encoded(std::move(packed->stream)), options);
}

void check_lr(const Subject& subject, const CornerTable& table, const Options& options, Format kind) {
    RingOptions ring = options.ring(table);
    ring.start = kNullCorner;  // it is a corner of the table before fans are split
    const std::array<std::uint32_t, 2> periods{0, options.byte[1]};
    Result<EncodedLr> lr = kind == Format::lr
                               ? encode_lr(table, ring, options.optimize(kLrRingCost), options.wart_skipping())
                               : encode_compact_lr(table, ring, std::span(periods).first(options.byte[1] == 0 ? 1 : 2));
    REQUIRE(lr);
    check_stream(subject, as_encoded(std::move(*lr)), options);
}

/// The triangles of a structure, found by its operators.
template <class View>
std::vector<Triangle> triangles_by_operators(const View& view, auto&& vertex_of) {
    std::vector<Triangle> out;
    for (std::uint32_t t = 0; t < view.triangle_numbers(); ++t) {
        if (!view.is_canonical(TriangleId{t})) continue;
        const CornerId c = view.corner(TriangleId{t});
        out.push_back(rotated({vertex_of(view.vertex(c)), vertex_of(view.vertex(view.next(c))),
                               vertex_of(view.vertex(view.previous(c)))}));
    }
    return sorted(std::move(out));
}

void check_rivals(const Mesh& mesh, CornerTable table) {
    split_fans(table);
    std::vector<std::uint32_t> corners;
    for (const CornerTable::Corner& c : table.corners) corners.push_back(c.vertex.value);
    const std::vector<Triangle> want = sorted(triangles_of(corners));
    const auto check = [&](const auto& view, auto&& vertex_of) {
        check_operators(view, view.triangle_numbers(), view.vertices);
        REQUIRE(triangles_by_operators(view, vertex_of) == want);
    };
    const auto same = [](VertexId v) { return v.value; };
    const WingedEdge winged = build_winged_edge(table);
    check(winged.view(), same);
    const CornerTableC flat = build_corner_table_c(table);
    check(flat.view(), same);
    LrMap map;
    const Result<Squad> squad = build_squad(table, {}, &map);
    REQUIRE(squad);
    check(squad->view(), [&](VertexId v) { return map.vertex[v.value].value; });

    std::vector<std::uint32_t> proper;
    for (const Triangle& t : triangles_of(mesh.indices)) proper.insert(proper.end(), t.begin(), t.end());
    if (proper.empty()) return;
    const Result<Strips> strips = make_strips(proper, mesh.vertex_count);
    if (!strips) return;
    REQUIRE(sorted(triangles_of(unstrip(strips->restart, true))) == sorted(triangles_of(proper)));
    REQUIRE(sorted(triangles_of(unstrip(strips->degenerate, false))) == sorted(triangles_of(proper)));
}

void run_chain(const Mesh& input, const Options& options) {
    const Subject subject = joined(welded(input, options.welding()), options);
    const Mesh& mesh = subject.whole;
    const Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    REQUIRE(table);
    check_table(mesh, *table);
    for (const CornerId c : seam_edges(*table, subject.mesh)) REQUIRE(c < table->opposite(c));
    const Positions positions = positions_of(mesh);
    REQUIRE(vertex_normals(*table, positions).size() == std::size_t{3} * mesh.vertex_count);
    const std::vector<ClosedShell> shells = closed_shells(*table, positions);
    const SmeshCheck smesh = check_smesh(*table, report_topology(*table), shells);
    REQUIRE(smesh.is_smesh() == smesh.reason.empty());

    if (options.wants(0)) check_lean(subject, *table, options);
    if (options.wants(1)) check_packed(subject, *table, options, PackedProfile::small);
    if (options.wants(2)) check_packed(subject, *table, options, PackedProfile::cache);
    if (options.wants(3)) check_lr(subject, *table, options, Format::lr);
    if (options.wants(4)) check_lr(subject, *table, options, Format::lr_compact);
    if (options.wants(5)) check_rivals(mesh, *table);
}

template <class T>
void append(std::vector<std::byte>& data, T value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    data.insert(data.end(), bytes.begin(), bytes.end());
}

/// Reads bytes as an index list of one or two bytes per index. The list is repeated several times with shifted
/// vertices, which makes meshes of many blocks from few bytes.
Mesh mesh_of_indices(std::span<const std::byte> bytes, const Options& options) {
    const std::uint32_t width = 1 + (options.byte[6] & 1), copies = 1 + (options.byte[6] >> 1) % 16;
    const std::uint32_t shift = options.byte[7];
    Mesh mesh;
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
        for (std::size_t i = 0; i + 3 * width <= bytes.size(); i += 3 * width) {
            for (std::size_t k = 0; k < 3 * width; k += width) {
                std::uint32_t v = std::to_integer<std::uint32_t>(bytes[i + k]);
                if (width == 2) v |= (std::to_integer<std::uint32_t>(bytes[i + k + 1]) & 0xf) << 8;
                mesh.indices.push_back(v + copy * shift);
                mesh.vertex_count = std::max(mesh.vertex_count, mesh.indices.back() + 1);
            }
        }
    }
    mesh.vertex_count += options.byte[1] % 3;  // unused vertices
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}}, color{"COLOR_0", ComponentType::u8, 3, true, {}};
    Attribute weight{"weight", ComponentType::f64, 1, false, {}};
    const std::uint32_t period = options.byte[5] % 4 == 0 ? 1 + options.byte[5] : UINT32_MAX;  // positions repeat
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const auto x = static_cast<float>(v % period);
        for (const float value : {x, x * x, x / 3.0F}) append(position.data, value);
        for (std::uint32_t k = 0; k < 3; ++k) append(color.data, static_cast<std::uint8_t>(v / (k + 1) & 0x7f));
        append(weight.data, static_cast<double>(v % 11));
    }
    mesh.attributes = {position, color, weight};
    return mesh;
}

bool run_indices(std::span<const std::byte> bytes) {
    if (bytes.size() < kOptionBytes + 3) return false;
    const Options options(bytes.last(kOptionBytes));
    const Mesh mesh = mesh_of_indices(bytes.first(bytes.size() - kOptionBytes), options);
    if (mesh.indices.empty()) return false;
    run_chain(mesh, options);
    return true;
}

bool run_file(std::span<const std::byte> bytes) {
    if (bytes.size() < kOptionBytes) return false;
    const Options options(bytes.last(kOptionBytes));
    const auto format = static_cast<MeshFormat>(options.byte[7] % 6);  // 0 is any format
    const std::vector<std::byte> file(bytes.begin(), bytes.end() - kOptionBytes);
    const Result<Mesh> mesh = read_mesh(file, {}, {.format = format, .max_bytes = 1 << 20});
    if (!mesh) return false;
    check_mesh(*mesh);
    if (mesh->triangle_count() > 2000 || mesh->vertex_count > 5000) return false;
    run_chain(*mesh, options);
    return true;
}

}  // namespace

extern const Target chain_indices_target{"chain_indices", run_indices, nullptr};
extern const Target chain_mesh_target{"chain_mesh", run_file, nullptr};

}  // namespace lacedring::fuzz
