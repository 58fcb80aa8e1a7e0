#pragma once
// Writes the parts of a glTF document that describe buffers: accessors, buffer views and buffers. Internal to lrio.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacedring/lr_file.hpp"
#include "lrio/scene/json_text.h"

namespace lacedring::detail {

inline constexpr std::string_view kExtension = "LACEDRING_mesh_compression";

/// The bytes of a buffer that is being made.
class BinChunk {
  public:
    /// Appends bytes; returns their offset, a multiple of `align`.
    std::size_t add(std::span<const std::byte> bytes, std::size_t align = 4);
    /// Appends `size` zeros; returns their offset, a multiple of 4.
    std::size_t add_zeros(std::size_t size);
    std::span<std::byte> bytes(std::size_t at, std::size_t size) { return std::span(bytes_).subspan(at, size); }
    std::vector<std::byte> take() { return std::move(bytes_); }
    std::size_t size() const { return bytes_.size(); }
    /// Reserves memory for `more` bytes, so that adding them does not copy the chunk.
    void expect(std::size_t more);

  private:
    std::vector<std::byte> bytes_;
};

/// Removes an accessor's references to buffer views.
void strip_accessor(JsonValue& accessor);

/// True: the accessor has the attribute's type, so the values need no conversion. False: values_as can convert them.
/// Errors: malformed (neither).
Result<bool> has_type_of(const JsonValue& accessor, const AttributeView& attribute);

/// Converts attribute.data to the accessor's type: integer positions are floats in the stream. Errors: malformed (a
/// value that the type does not hold).
Result<std::vector<std::byte>> values_as(const JsonValue& accessor, const AttributeView& attribute);

/// Sets the accessor's count and, for a position, its bounds, computed from attribute.data. Bounds that are right
/// already keep their text.
void describe_attribute(JsonText& json, JsonValue& accessor, const AttributeView& attribute, std::uint32_t vertices,
                        bool position);
void describe_indices(JsonText& json, JsonValue& accessor, std::size_t count, std::uint32_t vertices);

/// Bytes of the accessor's index type.
std::size_t index_size(const JsonValue& accessor);

/// Has the accessor a type that glTF allows for indices?
bool is_index_list(const JsonValue& accessor);

/// Writes the indices in the accessor's type, index_size bytes each. False: some index is too large for the type, whose
/// largest number is not a valid index.
bool put_indices(const JsonValue& accessor, std::span<const std::uint32_t> indices, std::span<std::byte> out);

/// Adds rows of `stride` bytes to `bin`, each padded to a multiple of 4 bytes; if `stride` is 0, adds indices. Returns
/// their buffer view.
JsonValue put_rows(JsonText& json, BinChunk& bin, std::span<const std::byte> bytes, std::size_t stride);

/// Makes a view of buffer 0, of rows of `stride` bytes, a multiple of 4; of indices if `stride` is 0.
JsonValue describe_view(JsonText& json, std::size_t at, std::size_t size, std::size_t stride);

/// Sets the document's buffers to one buffer of `size` bytes, or to none if `size` is 0. `uri` may be empty.
void describe_buffers(JsonText& json, std::size_t size, const std::string& uri);

/// Adds the name of our extension to the document's `list`: "extensionsUsed" or "extensionsRequired".
void list_extension(JsonText& json, std::string_view list);
/// Removes `name` from that list, and the list if it is then empty.
void unlist_extension(JsonValue& root, std::string_view list, std::string_view name);

/// The object of the extension in a value, or null.
const JsonValue* extension_of(const JsonValue& value);
/// Sets the object of the extension in a value; replaces an `extensions` that is not an object.
void set_extension(JsonValue& value, JsonValue extension);
/// Removes an extension from a value, and `extensions` if it is empty then.
void remove_extension(JsonValue& value, std::string_view name);

}  // namespace lacedring::detail
