#include "lrio/scene/quantization.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {
namespace {

/// The name without its suffixes "@TARGET" and "#NUMBER".
std::string_view semantic(std::string_view name) {
    return name.substr(0, name.find_first_of("@#"));
}
bool is_morph(std::string_view name) {
    return name.find('@') != std::string_view::npos;
}
bool is_weights(std::string_view name) {
    return semantic(name).starts_with("WEIGHTS_") && !is_morph(name);
}

double value_at(const Attribute& a, std::size_t i) {
    float value = 0;
    std::memcpy(&value, a.data.data() + 4 * i, sizeof value);
    return static_cast<double>(value);
}

/// The class of a size: the exponent of the power of two at or below it.
int size_class(double size) {
    return size > 0 && std::isfinite(size) ? static_cast<int>(std::floor(std::log2(size))) : INT16_MIN;
}

/// Rounds the weights of a vertex to multiples of 2^-bits, with a sum of exactly 1 if it was about 1.
void round_weights(std::vector<double>& weights, std::uint32_t bits) {
    const double all = std::ldexp(1.0, static_cast<int>(bits));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(std::abs(sum - 1) < 0.02) || static_cast<double>(weights.size()) > all) {
        for (double& w : weights) w = (w > 0 ? std::max(std::nearbyint(w * all), 1.0) : std::nearbyint(w * all)) / all;
        return;
    }
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> lost(weights.size());
    double left = all;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double exact = weights[i] / sum * all;
        // No positive weight becomes 0: its joint would have no effect.
        weights[i] = weights[i] > 0 ? std::max(std::floor(exact), 1.0) : 0.0;
        lost[i] = exact - weights[i];
        left -= weights[i];
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lost[a] > lost[b]; });
    for (std::size_t i = 0; i < order.size() && left > 0.5; ++i, --left) weights[order[i]] += 1;
    for (; left < -0.5; ++left) *std::max_element(weights.begin(), weights.end()) -= 1;
    for (double& w : weights) w /= all;
}

/// Rounds the weights of all vertices. `columns`: the attributes with weights. Returns the largest error of each.
std::vector<double> quantize_weights(Mesh& mesh, const std::vector<std::size_t>& columns, std::uint32_t bits) {
    std::vector<double> errors(columns.size(), 0), weights;
    for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
        weights.clear();
        for (const std::size_t c : columns) {
            const Attribute& a = mesh.attributes[c];
            for (std::size_t i = 0; i < a.components; ++i) weights.push_back(value_at(a, v * a.components + i));
        }
        round_weights(weights, bits);
        std::size_t next = 0;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            Attribute& a = mesh.attributes[columns[k]];
            for (std::size_t i = 0; i < a.components; ++i, ++next) {
                const std::size_t at = v * a.components + i;
                const auto rounded = static_cast<float>(weights[next]);
                errors[k] = std::max(errors[k], std::abs(value_at(a, at) - static_cast<double>(rounded)));
                std::memcpy(a.data.data() + 4 * at, &rounded, sizeof rounded);
            }
        }
    }
    return errors;
}

}  // namespace

SceneQuantization::SceneQuantization(const ScenePlan& plan, std::span<const SetMesh> meshes, const AttributeBits& bits)
    : bits_(bits) {
    measure_positions(plan, meshes);
    for (std::size_t s = 0; s < meshes.size(); ++s) {
        std::string kind = fmt::format("{}", position_class_[s]);
        std::vector<Column>& columns = columns_.emplace_back();
        for (const Attribute& a : meshes[s].mesh.attributes) {
            Column column{a.name, a.type, a.components, false, false, {}};
            if (a.type == ComponentType::f32) {
                column.roundable = column.unit_w = true;
                std::array<double, 16> low{}, high{};
                low.fill(INFINITY);
                high.fill(-INFINITY);
                for (std::size_t i = 0, size = a.data.size() / 4, c = 0; i < size;
                     ++i, c = c + 1 == a.components ? 0 : c + 1) {
                    const double value = value_at(a, i);
                    column.roundable = column.roundable && std::isfinite(value);
                    column.unit_w = column.unit_w && (c != 3 || value == 1 || value == -1);
                    low[c] = std::min(low[c], value);
                    high[c] = std::max(high[c], value);
                }
                for (std::size_t c = 0; c < a.components; ++c) {
                    column.range.extent = std::max(column.range.extent, high[c] - low[c]);
                    column.range.largest = std::max({column.range.largest, std::abs(low[c]), std::abs(high[c])});
                }
                if (a.name == "POSITION" && meshes[s].integer_positions) column.roundable = false;  // lossless
            }
            const bool by_size = a.type == ComponentType::f32 && semantic(a.name).starts_with("TEXCOORD_");
            kind += fmt::format("|{}|{}|{}|{}|{}|{}|{}", a.name, static_cast<int>(a.type), a.components, a.normalized,
                                column.roundable, column.unit_w, by_size ? size_class(column.range.extent) : 0);
            columns.push_back(std::move(column));
        }
        kinds_.push_back(std::move(kind));
    }
}

void SceneQuantization::measure_positions(const ScenePlan& plan, std::span<const SetMesh> meshes) {
    struct Box {
        std::array<double, 3> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
        double largest = 0;
        double extent() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 0.0}); }
        void add(const Box& other) {
            for (std::size_t c = 0; c < 3; ++c) {
                low[c] = std::min(low[c], other.low[c]);
                high[c] = std::max(high[c], other.high[c]);
            }
            largest = std::max(largest, other.largest);
        }
    };
    std::vector<Box> boxes(meshes.size());
    std::map<std::uint32_t, Box> mesh_boxes;  // by the mesh's index in the document
    for (std::size_t s = 0; s < meshes.size(); ++s) {
        for (const Attribute& a : meshes[s].mesh.attributes) {
            if (semantic(a.name) != "POSITION" || is_morph(a.name) || a.type != ComponentType::f32) continue;
            for (std::size_t i = 0; i < a.data.size() / 4; ++i) {
                const double value = value_at(a, i);
                if (!std::isfinite(value)) continue;
                boxes[s].low[i % 3] = std::min(boxes[s].low[i % 3], value);
                boxes[s].high[i % 3] = std::max(boxes[s].high[i % 3], value);
                boxes[s].largest = std::max(boxes[s].largest, std::abs(value));
            }
        }
        for (const ScenePart& part : plan.sets[s].parts) {
            for (const PrimitivePlace place : part.primitives) mesh_boxes[place.mesh].add(boxes[s]);
        }
    }
    std::vector<double> extents(meshes.size(), 0);
    double most = 0;
    for (std::size_t s = 0; s < meshes.size(); ++s) {
        for (const ScenePart& part : plan.sets[s].parts) {
            for (const PrimitivePlace place : part.primitives) {
                extents[s] = std::max(extents[s], mesh_boxes[place.mesh].extent());
            }
        }
        most = std::max(most, extents[s]);
    }
    struct Class {
        double extent = 0, largest = 0;
    };
    std::map<int, Class> classes;
    for (std::size_t s = 0; s < meshes.size(); ++s) {
        const int kind = extents[s] > 0 ? static_cast<int>(std::floor(std::log2(most / extents[s]) / 4)) : -1;
        position_class_.push_back(kind);
        classes[kind].extent = std::max(classes[kind].extent, extents[s]);
        classes[kind].largest = std::max(classes[kind].largest, boxes[s].largest);
    }
    if (bits_.positions == 0) return;
    for (const auto& [kind, size] : classes) {
        const double step = size.extent / ((std::uint32_t{1} << bits_.positions) - 1);
        position_steps_[kind] = step > 0 ? lattice_step(step, size.largest) : 0;
    }
}

std::vector<VertexOptions> SceneQuantization::options_of(std::span<const std::uint32_t> sets) const {
    std::vector<VertexOptions> out;
    const std::uint32_t first = sets.front();
    const auto found = position_steps_.find(position_class_[first]);
    const float position_step = found == position_steps_.end() ? 0 : found->second;
    for (std::size_t c = 0; c < columns_[first].size(); ++c) {
        const Column& column = columns_[first][c];
        const std::string_view name = semantic(column.name);
        VertexOptions options;
        const auto lattice = [&](float step) {
            if (!(step > 0)) return;
            options.mapping = VertexMapping::lattice;
            options.step = step;
        };
        Range range;  // maximum over all sets
        for (const std::uint32_t s : sets) {
            range.extent = std::max(range.extent, columns_[s][c].range.extent);
            range.largest = std::max(range.largest, columns_[s][c].range.largest);
        }
        const auto fraction = [](std::uint32_t bits) { return std::ldexp(1.0F, -static_cast<int>(bits)); };
        if (column.type != ComponentType::f32 || !column.roundable) {
            // lossless
        } else if (name == "POSITION") {
            lattice(position_step);
        } else if (name == "NORMAL" || name == "TANGENT") {
            if (bits_.normals > 0 && is_morph(column.name)) {
                lattice(lattice_step(static_cast<double>(fraction(bits_.normals - 1)), range.largest));
            } else if (bits_.normals > 0 && (column.components == 3 || (column.components == 4 && column.unit_w))) {
                options.mapping = VertexMapping::octahedral;
                options.bits = bits_.normals;
            }
        } else if (name.starts_with("TEXCOORD_") && bits_.texcoords > 0) {
            const double step = range.extent / ((std::uint32_t{1} << bits_.texcoords) - 1);
            lattice(step > 0 ? lattice_step(step, range.largest) : 0);
        } else if (name.starts_with("COLOR_") && bits_.colors > 0) {
            lattice(lattice_step(static_cast<double>(fraction(bits_.colors)), range.largest));
        } else if (is_weights(column.name) && bits_.weights > 0) {
            lattice(lattice_step(static_cast<double>(fraction(bits_.weights)), range.largest));
        }
        out.push_back(options);
    }
    return out;
}

Result<void> quantize(CodedSet& set, std::map<std::string, double>& errors) {
    Mesh& mesh = set.set.mesh;
    std::vector<std::size_t> weights;
    const auto tell = [&](std::size_t i, double error) {
        const Attribute& a = mesh.attributes[i];
        set.options[i].lost_before = error;
        double& most = errors[std::string(semantic(a.name)) + (is_morph(a.name) ? " of morph targets" : "")];
        most = std::max(most, error);
    };
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        Attribute& a = mesh.attributes[i];
        const VertexOptions& options = set.options[i];
        if (options.mapping != VertexMapping::lattice && options.mapping != VertexMapping::octahedral) continue;
        if (is_weights(a.name)) {
            weights.push_back(i);
            continue;
        }
        const auto error = quantize_vertices(a.data, a.components, options);
        if (!error) return Error{error.error().code, fmt::format("{}: {}", shown(a.name), error.error().message)};
        tell(i, *error);
    }
    if (weights.empty()) return {};
    const auto bits = static_cast<std::uint32_t>(-std::ilogb(set.options[weights[0]].step));
    const std::vector<double> lost = quantize_weights(mesh, weights, bits);
    for (std::size_t k = 0; k < weights.size(); ++k) tell(weights[k], lost[k]);
    return {};
}

void carry_errors(std::vector<CodedSet>& sets) {
    for (CodedSet& set : sets) {
        for (std::size_t i = 0; i < set.options.size(); ++i) {
            double& most = sets.front().options[i].lost_before;
            most = std::max(most, set.options[i].lost_before);
        }
    }
}

}  // namespace lacedring::detail
