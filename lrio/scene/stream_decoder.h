#pragma once
// Vertex sets and index lists out of a stream of the extension, each value written once, where it is to lie. Internal
// to lrio.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/lr_file.hpp"
#include "lrio/file/lr_layout.h"

namespace lacedring::detail {

class StreamDecoder {
  public:
    /// What the document says of the stream.
    struct Said {
        std::vector<std::uint32_t> set_of_part;
        /// Of each set; UINT32_MAX: what its triangles use, if no order was kept.
        std::vector<std::uint32_t> vertices;
    };
    /// Sees what the file says of itself before memory is taken for it.
    using Check = std::function<Result<void>(const LrFileView&)>;

    /// `file` begins at a multiple of 8 and stays where it is; `parts` are the part codes. Checks the connectivity, not
    /// the attributes. Errors: malformed, check's. Untrusted input: safe. Cost: O(T).
    static Result<StreamDecoder> open(std::span<const std::byte> file, std::span<const std::byte> parts, Said said,
                                      const Check& check = {});

    std::uint32_t vertices(std::size_t set) const { return said_.vertices[set]; }
    std::size_t parts() const { return corners_.size(); }
    std::size_t corners(std::size_t part) const { return corners_[part]; }
    std::span<const AttributeView> attributes() const { return view_.attributes; }

    /// Writes the values of an attribute, of each set's vertices to its place. Errors: malformed. Cost: O(V).
    Result<void> decode_attribute(std::size_t attribute, std::span<const std::span<std::byte>> sets);

    /// Writes the index list of each part, of its set's vertices. Cost: O(T).
    void decode_parts(std::span<const std::span<std::uint32_t>> parts) const;

  private:
    Result<void> read(std::span<const std::byte> file);
    Result<void> read_mesh(std::span<const std::byte> file);
    Result<void> read_parts(std::span<const std::byte> codes);
    Result<void> number_vertices();
    Result<void> number_by_ranges();
    Result<void> number_by_triangles();
    Result<void> decode_values(std::size_t attribute, std::span<std::byte> out) const;

    Said said_;
    LrFileView view_;
    std::unique_ptr<LrFile> restored_;    ///< whose view it is, if the file is in storage form
    DecodedLr decoded_;                   ///< what indices_ and row_of_ are made of
    std::optional<StreamView> stream_;    ///< decodes to the index list, if indices_ has it not
    std::optional<Mesh> mesh_;            ///< has the attributes' values, if they are not decoded where they are to lie
    std::vector<std::uint32_t> indices_;  ///< of the stream's vertices, or copies
    std::vector<std::uint32_t> row_of_;   ///< of each copy: the vertex whose values it has, where they are not its own
    std::vector<std::uint32_t> part_of_;  ///< of each triangle; empty: there is one part
    std::vector<std::uint32_t> set_of_;   ///< of each vertex; empty: there is one set
    std::vector<std::uint32_t> place_;    ///< of each vertex, in its set
    std::vector<std::size_t> corners_;    ///< of each part
    std::uint32_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
    bool in_order_ = false;  ///< vertices are numbered set by set
    std::vector<std::byte> scratch_;
};

}  // namespace lacedring::detail
