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

/// Bytes that become a buffer, and where the views of it begin.
class BinChunk {
  public:
    /// The place of the bytes, a multiple of `align`.
    std::size_t add(std::span<const std::byte> bytes, std::size_t align = 4);
    /// The place of so many zeros, a multiple of 4.
    std::size_t add_zeros(std::size_t size);
    std::span<std::byte> bytes(std::size_t at, std::size_t size) { return std::span(bytes_).subspan(at, size); }
    std::vector<std::byte> take() { return std::move(bytes_); }
    std::size_t size() const { return bytes_.size(); }
    /// Makes room for so many bytes more, so that they are not copied as the chunk grows.
    void expect(std::size_t more);

  private:
    std::vector<std::byte> bytes_;
};

/// Takes from an accessor what says where its values lie.
void strip_accessor(JsonValue& accessor);

/// Has the accessor the attribute's type, so that it may have its values as they are? It may also be one that
/// values_as converts to. Errors: malformed (neither).
Result<bool> has_type_of(const JsonValue& accessor, const AttributeView& attribute);

/// The attribute's values, of `data`, in the accessor's type, by which they may differ from the stream's (integer
/// positions). Errors: malformed (a position that the type does not hold).
Result<std::vector<std::byte>> values_as(const JsonValue& accessor, const AttributeView& attribute);

/// Sets count, and with `position` the bounds, of `data`; texts that say the same already stay.
void describe_attribute(JsonText& json, JsonValue& accessor, const AttributeView& attribute, std::uint32_t vertices,
                        bool position);
void describe_indices(JsonText& json, JsonValue& accessor, std::size_t count, std::uint32_t vertices);

/// Bytes of an index of the accessor.
std::size_t index_size(const JsonValue& accessor);

/// Has the accessor a type that indices may have?
bool is_index_list(const JsonValue& accessor);

/// Writes the indices in the accessor's type: index_size of each. False: it does not hold all of them; its greatest
/// number is none.
bool put_indices(const JsonValue& accessor, std::span<const std::uint32_t> indices, std::span<std::byte> out);

/// Puts rows of `stride` bytes, made multiples of 4, into `bin`, or indices, where `stride` is 0; their buffer view.
JsonValue put_rows(JsonText& json, BinChunk& bin, std::span<const std::byte> bytes, std::size_t stride);

/// A buffer view of buffer 0: of rows of a multiple of 4 bytes, or of indices, where `stride` is 0.
JsonValue describe_view(JsonText& json, std::size_t at, std::size_t size, std::size_t stride);

/// Makes one buffer of the document's, or none of no bytes; `uri` may be empty.
void describe_buffers(JsonText& json, std::size_t size, const std::string& uri);

/// Puts the extension's name on a list of the document, or takes it off.
void list_extension(JsonText& json, std::string_view list);
void unlist_extension(JsonValue& root, std::string_view list, std::string_view name);

/// The object of the extension in a value, or null.
const JsonValue* extension_of(const JsonValue& value);
/// Puts it there, whatever `extensions` was.
void set_extension(JsonValue& value, JsonValue extension);
/// Takes the extension out of a value, and `extensions` where nothing else is in it.
void remove_extension(JsonValue& value, std::string_view name);

}  // namespace lacedring::detail
