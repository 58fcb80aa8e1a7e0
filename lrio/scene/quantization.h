#pragma once
// To what the values of a scene's attributes are rounded. Internal to lrio.
//
// Positions lie on one lattice, so that primitives meet where they met: that of the largest mesh, for all that are no
// smaller than a sixteenth of it; smaller ones have one of their own size.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lrio/scene/scene_stream.h"

namespace lacedring::detail {

class SceneQuantization {
  public:
    /// The plan and the meshes, one for each set of it, need not live on.
    SceneQuantization(const ScenePlan& plan, std::span<const SetMesh> meshes, const AttributeBits& bits);

    /// Sets of one kind have the same attributes, coded alike: they may share a stream.
    const std::string& kind_of(std::size_t set) const { return kinds_[set]; }
    /// How each attribute of these sets, which are of one kind, is coded.
    std::vector<VertexOptions> options_of(std::span<const std::uint32_t> sets) const;

  private:
    struct Range {
        double extent = 0, largest = 0;  ///< of any component, and the farthest from 0
    };
    struct Column {
        std::string name;
        ComponentType type = ComponentType::f32;
        std::uint8_t components = 0;
        bool roundable = false;  ///< floats that are finite, and not integers of the source
        bool unit_w = false;
        Range range;
    };
    void measure_positions(const ScenePlan& plan, std::span<const SetMesh> meshes);

    AttributeBits bits_;
    std::vector<std::string> kinds_;
    std::vector<std::vector<Column>> columns_;  ///< of each set
    std::vector<int> position_class_;           ///< of each set
    std::map<int, float> position_steps_;       ///< of each class
};

/// Rounds the values as `set.options` say, weights so that their sum stays 1, and raises the errors by attribute.
/// Errors: encode_vertices'.
Result<void> quantize(CodedSet& set, std::map<std::string, double>& errors);

/// Gives all of them the largest error that any has.
void carry_errors(std::vector<CodedSet>& sets);

}  // namespace lacedring::detail
