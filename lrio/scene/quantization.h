#pragma once
// Chooses the quantization of a scene's attributes. Internal to lrio.
//
// Meshes of similar size share a lattice for positions, so that their primitives still meet after rounding: one lattice
// for sizes from the largest down to a sixteenth of it, and one for each further factor of 16.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lrio/scene/scene_stream.h"

namespace lacedring::detail {

class SceneQuantization {
  public:
    /// `meshes` has a mesh for each set of the plan. Both may be destroyed after the call.
    SceneQuantization(const ScenePlan& plan, std::span<const SetMesh> meshes, const AttributeBits& bits);

    /// Sets of the same kind have the same attributes with the same coding: they may share a stream.
    const std::string& kind_of(std::size_t set) const { return kinds_[set]; }
    /// The coding of each attribute of these sets, which are of the same kind.
    std::vector<VertexOptions> options_of(std::span<const std::uint32_t> sets) const;

  private:
    struct Range {
        double extent = 0, largest = 0;  ///< largest extent of a component; largest magnitude
    };
    struct Column {
        std::string name;
        ComponentType type = ComponentType::f32;
        std::uint8_t components = 0;
        bool roundable = false;  ///< finite floats that are not converted integers
        bool unit_w = false;     ///< the fourth component, if any, is always 1 or -1
        Range range;
    };
    void measure_positions(const ScenePlan& plan, std::span<const SetMesh> meshes);

    AttributeBits bits_;
    std::vector<std::string> kinds_;
    std::vector<std::vector<Column>> columns_;  ///< attributes of each set
    std::vector<int> position_class_;           ///< size class of each set
    std::map<int, float> position_steps_;       ///< lattice step of each class
};

/// Rounds the values by set.options; rounds weights so that their sum stays 1. Raises each attribute's largest error in
/// `errors`. Errors: those of encode_vertices.
Result<void> quantize(CodedSet& set, std::map<std::string, double>& errors);

/// Sets lost_before of the first set's options to the largest of all sets.
void carry_errors(std::vector<CodedSet>& sets);

}  // namespace lacedring::detail
