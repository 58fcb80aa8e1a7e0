#pragma once
// The .lr file: the connectivity of a mesh's surface as a lean or packed stream or as LR tables, its seams, the
// attributes of its vertices and their copies in ring order, as vertex streams or as they lie in memory, and, on
// request, the way back to the input's order. docs/lr-file.md has the format to the byte.

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

/// An attribute of a file: its values, or a vertex stream of them.
struct LrAttribute : Attribute {       ///< data is empty where there is a stream; the rest is what it decodes to
    std::vector<std::uint32_t> words;  ///< a vertex stream (vertices.hpp), or empty
    bool per_copy = false;             ///< one value for each of copy_count, not of vertex_count
};

/// "Copies" are vertex copies, which differ in attributes. LR tables have an extra vertex for each further fan of a
/// non-manifold vertex, which counts as a vertex and has a copy.
struct LrFile {
    std::uint32_t vertex_count = 0;     ///< of the connectivity: of the surface, and extra ones
    std::uint32_t copy_count = 0;       ///< 0: there are no seams, and vertices are what triangles name
    std::uint32_t input_triangles = 0;  ///< of the mesh it was made from, degenerate ones included
    Format format = Format::lean;
    std::vector<std::uint32_t> words;         ///< the connectivity stream, its header included
    std::vector<std::uint32_t> seams;         ///< the seam section (seams.hpp), or empty
    std::vector<LrAttribute> attributes;      ///< in ring order; the first one, POSITION, never per copy
    std::vector<std::uint32_t> vertex_order;  ///< vertex_order[new] = old, of copies where there are; empty unless kept
    /// corner_order[i] = 3 * triangle + place: the corner of the input's index list that the i-th triangle decoded
    /// begins with; empty unless kept.
    std::vector<std::uint32_t> corner_order;
};

/// The file of a mesh and of what encode() made of it; `encoded` is taken over. Attributes are as they lie in memory.
/// The way back to the input's order is kept only with `keep_order`: 4 bytes a vertex and 4 a triangle. Cost: O(T).
LrFile make_lr_file(const Mesh& mesh, Encoded encoded, bool keep_order);

/// The same of a mesh with seams; encode() was given the surface's triangles (surface_mesh). Each vertex has the
/// position of its first copy (move_to_surface). An attribute on which all
/// copies of each vertex agree has a value a vertex. Cost and errors: encode_seams'.
Result<LrFile> make_lr_file(const Mesh& mesh, const Surface& surface, Encoded encoded, bool keep_order);

/// The bits to which attributes are quantized; 0: lossless.
struct AttributeBits {
    std::uint32_t positions = 0;  ///< 1 to 22, of POSITION: along the largest extent, as all but normals
    std::uint32_t normals = 0;    ///< 2 to 16, of NORMAL and TANGENT: of each of two octahedral integers
    std::uint32_t texcoords = 0;  ///< 1 to 22, of TEXCOORD_n
    std::uint32_t colors = 0;     ///< 1 to 22, of COLOR_n
    std::uint32_t weights = 0;    ///< 1 to 22, of WEIGHTS_n
    float position_step = 0;      ///< VertexOptions::step of POSITION, instead of bits
    unsigned threads = 1;
};

/// The options by which compress_attributes tries to code an attribute: a lattice or octahedral if bits are given and
/// the values are floats, else lossless. An attribute that cannot be coded so becomes lossless.
VertexOptions vertex_options(const Attribute& attribute, const AttributeBits& bits);

/// The result of compressing an attribute.
struct CompressedAttribute {
    std::string name;
    std::uint64_t bytes_before = 0, bytes = 0;  ///< of its values, and of the stream
    double largest_error = 0;
    std::string exact;  ///< why it is lossless although bits were given, or empty
};

/// Makes vertex streams of the attributes. Those that cannot be quantized as `bits` says (integers; values that are not
/// finite) are lossless; those of more than 16 integers a vertex, or of floats that call themselves
/// normalized, stay as they are. Cost: encode_vertices'. Errors:
/// invalid_argument (bits), too_large.
Result<std::vector<CompressedAttribute>> compress_attributes(LrFile& file, const AttributeBits& bits = {});

/// How a file holds its streams.
enum class LrForm : std::uint8_t {
    resident,  ///< as a program or a GPU reads them at random: in a mapped file, in place
    stored,  ///< coded through and through, smaller, for disks and networks: parse_lr makes the resident streams of it,
             ///< bit for bit. Streams that have no storage form, or one that is not smaller, stay resident; so do all
             ///< where restoring them would take more memory than parse_lr takes unless it is told
};

/// The file's bytes. Cost: O(file); stored, about a microsecond a triangle.
std::vector<std::byte> serialize_lr(const LrFile& file, LrForm form = LrForm::resident);

/// Reads and checks everything: structure, checksums, stream, permutations, finite positions. Streams in storage form
/// may be many times as large as what is stored: `max_bytes` is what they may take, or, where it is 0, 512 MiB or 128
/// times the file, whichever is more. `threads`: at most so many restore them. Errors: malformed, too_large,
/// memory_limit. Untrusted input: safe. Cost: O(file).
Result<LrFile> parse_lr(std::span<const std::byte> bytes, std::uint64_t max_bytes = 0, unsigned threads = 1);

Result<void> write_lr(const LrFile& file, const std::filesystem::path& path, LrForm form = LrForm::resident);
Result<LrFile> read_lr(const std::filesystem::path& path);

/// Do the bytes begin as an .lr file does?
bool is_lr(std::span<const std::byte> bytes);

/// The sections of a file, in their order.
struct LrSection {
    std::string kind;  ///< "lean", "packed", "lr", "lr_compact", "attribute", "vertices" (an attribute as a vertex
                       ///< stream), "seams", "vertex_order" or "corner_order"
    std::string name;  ///< of an attribute
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 0;
    bool per_copy = false;    ///< of an attribute
    bool stored = false;      ///< in storage form
    std::uint64_t bytes = 0;  ///< of its contents
    std::string mapping;  ///< of a vertex stream: "integers", "lattice", "octahedral", "floats", "decimals", "doubles"
    float largest_error = 0;  ///< of a vertex stream
};
struct LrContents {
    std::uint32_t version = 0;
    std::uint32_t vertices = 0;         ///< LrFile::vertex_count
    std::uint32_t copies = 0;           ///< LrFile::copy_count
    std::uint32_t input_triangles = 0;  ///< degenerate ones included
    std::uint64_t bytes = 0;            ///< of the whole file
    std::vector<LrSection> sections;
};
/// Checks the structure of the file, not what is in the sections. Errors: malformed. Untrusted input: safe.
Result<LrContents> list_lr(std::span<const std::byte> bytes);

/// An attribute where it lies in a file's bytes.
struct AttributeView {
    std::string_view name;
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 0;
    bool normalized = false, v_up = false, per_copy = false;
    std::span<const std::byte> data;       ///< as Attribute::data; empty where there is a stream
    std::span<const std::uint32_t> words;  ///< a vertex stream, whose header alone was checked; or empty
};

/// What a file holds, where it lies in the file's bytes. Holds no copy.
struct LrFileView {
    std::uint32_t vertex_count = 0, copy_count = 0, input_triangles = 0;  ///< as LrFile's
    Format format = Format::lean;
    std::span<const std::uint32_t> words, seams;
    std::vector<AttributeView> attributes;
    std::span<const std::uint32_t> vertex_order, corner_order;  ///< empty unless kept

    /// Checks the words and the seams, and that they have as many vertices and copies as the attributes. Errors:
    /// malformed. Cost: O(T); 12 bytes a triangle where there are seams. Untrusted input: safe.
    Result<StreamView> validate() const;
    /// The positions, for reading; none if the file has none, or as a vertex stream.
    Positions positions() const;
};

/// A file in memory, for one that is mapped (MappedFile, file.hpp) above all: `bytes` begin at a multiple of 8. Checks
/// the structure of the file and the sizes of all sections, not what is in them: call validate() or trust the words;
/// the orders' entries may be any numbers. Errors: malformed, invalid_argument (the address), unsupported (streams in
/// storage form, which parse_lr reads). Untrusted input: safe.
/// Cost: O(1) in the size of the mesh.
Result<LrFileView> view_lr_file(std::span<const std::byte> bytes);

/// Decodes to a mesh in stream order, extra vertices left out again: over the copies, as a GPU draws it. `surface`,
/// which may be null, gets the way to the surface's vertices. `file` is valid (parse_lr checked it, or make_lr_file
/// made it). Errors: malformed (its words are no stream).
Result<Mesh> decode_lr(const LrFile& file, Surface* surface = nullptr);

/// Decodes to the input's index list: its order of vertices and of triangles, each beginning with its first corner.
/// Degenerate triangles are missing. Errors: invalid_argument if the order was not kept.
Result<Mesh> decode_lr_original_order(const LrFile& file);

}  // namespace lacedring
