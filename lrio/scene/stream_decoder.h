#pragma once
// Decodes a stream of the extension to vertex sets and index lists, directly to their final places. Internal to lrio.

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
    /// What the document states about the stream.
    struct Said {
        std::vector<std::uint32_t> set_of_part;
        /// Number of vertices of each set; UINT32_MAX: unknown, allowed only if the order was not kept.
        std::vector<std::uint32_t> vertices;
    };
    /// Checks the file's view before memory is allocated for decoding.
    using Check = std::function<Result<void>(const LrFileView&)>;

    /// `file` begins at a multiple of 8 and outlives the result; `parts` are the part codes. Checks the connectivity,
    /// not the attributes. Errors: malformed, those of `check`. Untrusted input: safe. Cost: O(T).
    static Result<StreamDecoder> open(std::span<const std::byte> file, std::span<const std::byte> parts, Said said,
                                      const Check& check = {});

    std::uint32_t vertices(std::size_t set) const { return said_.vertices[set]; }
    std::size_t parts() const { return corners_.size(); }
    std::size_t corners(std::size_t part) const { return corners_[part]; }
    std::span<const AttributeView> attributes() const { return view_.attributes; }

    /// Writes an attribute's values of each set to sets[set]. Errors: malformed. Cost: O(V).
    Result<void> decode_attribute(std::size_t attribute, std::span<const std::span<std::byte>> sets);

    /// Writes the index list of each part to parts[part]; indices count the vertices of the part's set. Cost: O(T).
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
    std::unique_ptr<LrFile> restored_;    ///< the file of view_, if it was in storage form
    DecodedLr decoded_;                   ///< moved to indices_ and row_of_
    std::optional<StreamView> stream_;    ///< set: indices_ is empty, and decode_parts decodes this stream
    std::optional<Mesh> mesh_;            ///< attributes in an order other than the stream's
    std::vector<std::uint32_t> indices_;  ///< triangles of the stream's vertices, or of copies
    std::vector<std::uint32_t> row_of_;   ///< vertex of each copy, for attributes that are not per copy
    std::vector<std::uint32_t> part_of_;  ///< part of each triangle; empty: there is one part
    std::vector<std::uint32_t> set_of_;   ///< set of each vertex; empty: there is one set
    std::vector<std::uint32_t> place_;    ///< index of each vertex in its set
    std::vector<std::size_t> corners_;    ///< number of corners of each part
    std::uint32_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
    bool in_order_ = false;  ///< the input's order was kept: vertices are numbered set by set
    std::vector<std::byte> scratch_;
};

}  // namespace lacedring::detail
