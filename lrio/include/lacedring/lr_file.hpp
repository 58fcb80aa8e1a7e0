#pragma once
// The .lr file. It holds the connectivity of a mesh's surface (a lean or packed stream, or LR tables), the seams, the
// attributes of vertices and copies in ring order (vertex streams or plain values) and, on request, the permutations
// back to the input's order. docs/lr-file.md specifies every byte.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/surface.hpp"

namespace lacedring {

/// An attribute of a file: plain values, or a vertex stream. With a stream, `data` is empty, and the other members of
/// Attribute describe the decoded values.
struct LrAttribute : Attribute {
    std::vector<std::uint32_t> words;  ///< a vertex stream (vertices.hpp), or empty
    bool per_copy = false;             ///< has a value for each of copy_count, not of vertex_count
};

/// A copy is one of the input vertices joined into a surface vertex; the copies of a vertex differ in attributes. In LR
/// tables, each fan of a non-manifold vertex after the first has an extra vertex: it counts as a vertex and has a copy.
struct LrFile {
    std::uint32_t vertex_count = 0;     ///< vertices of the connectivity: the surface's and the extra ones
    std::uint32_t copy_count = 0;       ///< 0: no seams; triangles index vertices, else copies
    std::uint32_t input_triangles = 0;  ///< triangles of the input mesh, degenerate ones included
    Format format = Format::lean;
    std::vector<std::uint32_t> words;     ///< the connectivity stream, its header included
    std::vector<std::uint32_t> seams;     ///< the seam section (seams.hpp), or empty
    std::vector<LrAttribute> attributes;  ///< in ring order; the first is POSITION, never per copy
    /// vertex_order[new] = old: of copies if the file has seams, else of vertices; empty unless kept.
    std::vector<std::uint32_t> vertex_order;
    /// corner_order[i] = 3 * triangle + k, k < 3: the corner of the input's index list with which the i-th decoded
    /// triangle begins; empty unless kept.
    std::vector<std::uint32_t> corner_order;
};

/// Makes the file of a mesh and of encode()'s result, which is moved in. Attributes become plain values. `keep_order`
/// keeps the input's order, for 4 bytes a vertex and 4 bytes a triangle. Cost: O(T).
LrFile make_lr_file(const Mesh& mesh, Encoded encoded, bool keep_order);

/// Makes the file of a mesh with seams. `encoded` is of the surface's triangles (surface_mesh). All copies of a vertex
/// have its position (move_to_surface). An attribute whose copies agree at every vertex is stored per vertex. Cost and
/// errors: as encode_seams.
Result<LrFile> make_lr_file(const Mesh& mesh, const Surface& surface, Encoded encoded, bool keep_order);

/// Quantization bits of each kind of attribute, counted along its largest extent except for normals. 0: lossless.
struct AttributeBits {
    std::uint32_t positions = 0;  ///< POSITION: 1 to 22
    std::uint32_t normals = 0;    ///< NORMAL and TANGENT: 2 to 16 for each of two octahedral integers
    std::uint32_t texcoords = 0;  ///< TEXCOORD_n: 1 to 22
    std::uint32_t colors = 0;     ///< COLOR_n: 1 to 22
    std::uint32_t weights = 0;    ///< WEIGHTS_n: 1 to 22
    float position_step = 0;      ///< VertexOptions::step of POSITION, instead of bits
    unsigned threads = 1;
};

/// The options that compress_attributes tries first: lattice or octahedral if bits are given and the values are floats,
/// else lossless. If the attribute cannot be coded with them, it becomes lossless.
VertexOptions vertex_options(const Attribute& attribute, const AttributeBits& bits);

/// The result of compressing an attribute.
struct CompressedAttribute {
    std::string name;
    std::uint64_t bytes_before = 0, bytes = 0;  ///< bytes of the plain values, and of the stream
    double largest_error = 0;
    std::string exact;  ///< why it is lossless although bits were given, or empty
};

/// Makes vertex streams of the attributes. An attribute that cannot be quantized (integers; values that are not finite)
/// becomes lossless. An attribute of more than 16 integers a vertex, or of floats marked normalized, stays plain.
/// Cost: as encode_vertices. Errors: invalid_argument (bits), too_large.
Result<std::vector<CompressedAttribute>> compress_attributes(LrFile& file, const AttributeBits& bits = {});

/// How a file holds its streams.
enum class LrForm : std::uint8_t {
    /// Random access: a program or a GPU can read them in place, for example in a mapped file.
    resident,
    /// Entropy-coded and smaller, for disks and networks; parse_lr restores the resident streams bit for bit. A stream
    /// without a storage form, or without a smaller one, stays resident. All streams stay resident if restoring them
    /// would exceed parse_lr's default memory limit.
    stored,
};

/// The file's bytes. Cost: O(file); for LrForm::stored, about a microsecond a triangle.
std::vector<std::byte> serialize_lr(const LrFile& file, LrForm form = LrForm::resident);

/// Reads and checks everything: structure, checksums, stream, permutations, finite positions. Streams in storage form
/// grow many times when restored: `max_bytes` limits their memory; 0: 512 MiB or 128 times the file, whichever is more.
/// At most `threads` threads restore them. Errors: malformed, too_large, memory_limit. Untrusted input: safe. Cost:
/// O(file).
Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes = 0, unsigned threads = 1);

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path, LrForm form = LrForm::resident);
Result<LrFile> read_lr(const std::filesystem::path& path);

/// Do the bytes begin with the signature of .lr files?
bool is_lr(std::span<const std::byte> bytes);

/// A section of a file.
struct LrSection {
    /// "lean", "packed", "lr", "lr_compact", "attribute", "vertices" (an attribute as a vertex stream), "seams",
    /// "vertex_order" or "corner_order".
    std::string kind;
    std::string name;  ///< the attribute's name
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 0;
    bool per_copy = false;    ///< LrAttribute::per_copy
    bool stored = false;      ///< in storage form
    std::uint64_t bytes = 0;  ///< size of the contents
    /// A vertex stream's: "integers", "lattice", "octahedral", "floats", "decimals" or "doubles".
    std::string mapping;
    float largest_error = 0;  ///< a vertex stream's
};
struct LrContents {
    std::uint32_t version = 0;
    std::uint32_t vertices = 0;         ///< LrFile::vertex_count
    std::uint32_t copies = 0;           ///< LrFile::copy_count
    std::uint32_t input_triangles = 0;  ///< degenerate ones included
    std::uint64_t bytes = 0;            ///< size of the whole file
    std::vector<LrSection> sections;    ///< in the order of the file
};
/// Lists the sections. Checks the structure of the file, not the sections' contents. Errors: malformed. Untrusted
/// input: safe.
Result<LrContents> list_lr(std::span<const std::byte> bytes);

/// An attribute in a file's bytes; does not own them.
struct AttributeView {
    std::string_view name;
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 0;
    bool normalized = false, v_up = false, per_copy = false;
    std::span<const std::byte> data;       ///< as Attribute::data; empty if there is a stream
    std::span<const std::uint32_t> words;  ///< a vertex stream of which only the header was checked; or empty
};

/// The contents of a file as views of its bytes; copies nothing.
struct LrFileView {
    std::uint32_t vertex_count = 0, copy_count = 0, input_triangles = 0;  ///< as LrFile's
    Format format = Format::lean;
    std::span<const std::uint32_t> words, seams;
    std::vector<AttributeView> attributes;
    std::span<const std::uint32_t> vertex_order, corner_order;  ///< empty unless kept

    /// Checks the words and the seams, and that their numbers of vertices and copies are the file's. Errors: malformed.
    /// Cost: O(T); with seams, 12 bytes a triangle. Untrusted input: safe.
    Result<StreamView> validate() const;
    /// The positions; empty if the file has none, or has them as a vertex stream.
    Positions positions() const;
};

/// Views a file in memory, typically a mapped one (MappedFile, file.hpp); `bytes` begin at a multiple of 8. Checks the
/// structure of the file and the sizes of all sections, not their contents: call validate() unless you trust the words;
/// the entries of the orders may be any numbers. Errors: malformed, invalid_argument (alignment), unsupported (streams
/// in storage form; parse_lr reads them). Untrusted input: safe. Cost: O(1) in the size of the mesh.
Result<LrFileView> view_lr_file(std::span<const std::byte> bytes);

/// Decodes to a mesh in stream order, without the extra vertices. With seams, the mesh's vertices are the copies, and
/// `surface`, which may be null, maps them to surface vertices. `file` is valid: made by parse_lr or make_lr_file.
/// Errors: malformed (its words are no stream).
Result<Mesh> decode_lr(const LrFile& file, Surface* surface = nullptr);

/// Decodes to the input's index list: its order of vertices, of triangles, and of the corners of each triangle.
/// Degenerate triangles are missing. Errors: invalid_argument if the order was not kept.
Result<Mesh> decode_lr_original_order(const LrFile& file);

}  // namespace lacedring
