#pragma once
// A mesh as an .lr file in memory, and the options for its attributes. Shared by encode and stats --table total.

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "lacedring/lr_file.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

/// Names of the options that add_attribute_bits adds.
constexpr std::initializer_list<const char*> kAttributeBits = {"--positions", "--normals", "--texcoords", "--colors",
                                                               "--weights"};
void add_attribute_bits(CLI::App& command, AttributeBits& bits);

/// Returns whether any attribute is quantized.
bool quantizes(const AttributeBits& bits);

struct WholeFile {
    LrFile file;
    std::vector<CompressedAttribute> attributes;  ///< empty: stored uncompressed
    std::vector<std::byte> bytes;
};
/// `table`: the surface's corner table. Errors: malformed (all triangles are degenerate), those of encode, make_lr_file
/// and compress_attributes.
Result<WholeFile> make_file(const Mesh& mesh, const Surface& surface, CornerTable table, const EncodeOptions& options,
                            const AttributeBits& bits, bool keep_order = false);

/// Adds a note for each attribute that stays lossless although bits were given, with the reason.
void note_lossless(RunLog& log, const std::string& input, const std::vector<CompressedAttribute>& attributes);

}  // namespace lacedring::app
