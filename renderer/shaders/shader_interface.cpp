#include "renderer/shaders/shader_interface.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace lacedring::gpu {
namespace {

// Opcodes, storage classes and decorations of SPIR-V, as far as glslang writes them.
enum Op : std::uint32_t {
    op_entry_point = 15,
    op_execution_mode = 16,
    op_capability = 17,
    op_first_type = 19,
    op_type_vector = 23,  // from here on, the first operand is a type
    op_type_array = 28,
    op_type_struct = 30,
    op_type_pointer = 32,
    op_last_type = 39,
    op_constant = 43,
    op_spec_constant = 50,
    op_function = 54,
    op_variable = 59,
    op_decorate = 71,
    op_member_decorate = 72,
    op_execution_mode_id = 331,
};
enum Storage : std::uint32_t { uniform_constant = 0, input = 1, uniform = 2, output = 3, push = 9, buffer = 12 };
enum Decoration : std::uint32_t {
    spec_id = 1,
    built_in_value = 11,
    non_writable = 24,
    location = 30,
    component = 31,
    binding = 33,
    set = 34,
};
// Execution modes: workgroup size, and the input and output primitives of geometry and mesh shaders.
constexpr std::uint32_t kLocalSize = 17, kLocalSizeId = 38;
constexpr std::array<std::uint32_t, 13> kPrimitives{0, 19, 20, 21, 22, 23, 26, 27, 28, 29, 5269, 5270, 5298};
// Capabilities that every device has or that context.cpp always enables: Matrix, Shader, Geometry, Sampled1D, Image1D,
// SampledBuffer, ImageBuffer, ImageQuery, DerivativeControl, PhysicalStorageBufferAddresses.
constexpr std::array<std::uint32_t, 10> kAlways{0, 1, 2, 43, 44, 46, 47, 50, 51, 5347};
// Member decorations that the host depends on: offsets, strides, matrix order, read only, built in.
constexpr std::array<std::uint32_t, 8> kOfTypes{2, 3, 4, 5, 6, 7, 11, 24};

using Words = std::span<const std::uint32_t>;

struct Interface {
    std::uint32_t stage = ~0U;
    std::set<std::uint32_t> capabilities;
    /// Maps an interface slot ("binding 3", "input 0", "push constants") to a text that describes its type.
    std::map<std::string, std::string> places;
};

class Module {
  public:
    static Result<Interface> read(Words words);

  private:
    /// Describes everything that determines the memory layout of a type.
    std::string type_text(std::uint32_t id, int depth = 0) const;
    std::string value_text(std::uint32_t id) const;
    const std::uint32_t* decoration(std::uint32_t id, Decoration which) const;
    std::string place(std::uint32_t variable, std::uint32_t storage) const;
    bool is_built_in(std::uint32_t type) const;

    std::map<std::uint32_t, Words> definitions_;         // types and constants: the instruction without its first word
    std::map<std::uint32_t, std::uint32_t> operations_;  // by id of a type: its opcode
    std::map<std::uint32_t, std::vector<Words>> decorations_;                          // by id: decoration, operands
    std::map<std::uint32_t, std::map<std::uint32_t, std::vector<Words>>> of_members_;  // by id and member
};

std::string numbers(Words words) {
    std::string out;
    for (const std::uint32_t word : words) out += ' ' + std::to_string(word);
    return out;
}

template <class Set>
bool contains(const Set& set, std::uint32_t value) {
    return std::find(set.begin(), set.end(), value) != set.end();
}

const std::uint32_t* Module::decoration(std::uint32_t id, Decoration which) const {
    const auto at = decorations_.find(id);
    if (at == decorations_.end()) return nullptr;
    for (const Words& one : at->second) {
        if (one[0] == which) return one.data() + (one.size() > 1 ? 1 : 0);
    }
    return nullptr;
}

std::string Module::value_text(std::uint32_t id) const {
    if (const std::uint32_t* number = decoration(id, spec_id)) return "constant " + std::to_string(*number);
    const auto at = definitions_.find(id);
    return at == definitions_.end() || at->second.size() < 3 ? "?" : numbers(at->second.subspan(2));
}

std::string Module::type_text(std::uint32_t id, int depth) const {
    const auto kind = operations_.find(id);
    if (kind == operations_.end() || depth > 16) return "?";
    const Words words = definitions_.at(id);  // id, then operands
    const std::uint32_t operation = kind->second;
    std::string out = std::to_string(operation);
    if (operation == op_type_pointer) return out;  // an address, whatever it points to
    if (const auto decorated = decorations_.find(id); decorated != decorations_.end()) {
        for (const Words& one : decorated->second) {
            if (contains(kOfTypes, one[0])) out += " @" + numbers(one);
        }
    }
    out += " (";
    for (std::size_t i = 1; i < words.size(); ++i) {
        const bool is_type = operation >= op_type_struct || (operation >= op_type_vector && i == 1);
        if (operation == op_type_array && i == 2) {
            out += value_text(words[i]);
        } else if (is_type && operations_.contains(words[i])) {
            out += type_text(words[i], depth + 1);
        } else {
            out += ' ' + std::to_string(words[i]);
        }
        if (operation != op_type_struct) continue;
        const auto members = of_members_.find(id);
        if (members == of_members_.end()) continue;
        const auto member = members->second.find(static_cast<std::uint32_t>(i - 1));
        if (member == members->second.end()) continue;
        for (const Words& one : member->second) {
            if (contains(kOfTypes, one[0])) out += " @" + numbers(one);
        }
    }
    return out + ")";
}

/// True if the type is a block of built-in values, or an array of such blocks.
bool Module::is_built_in(std::uint32_t type) const {
    for (int depth = 0; depth < 4; ++depth) {
        if (const auto members = of_members_.find(type); members != of_members_.end()) {
            for (const auto& [member, all] : members->second) {
                for (const Words& one : all) {
                    if (one[0] == built_in_value) return true;
                }
            }
            return false;
        }
        const auto at = definitions_.find(type);
        if (at == definitions_.end() || at->second.size() < 2) return false;
        type = at->second[1];
    }
    return false;
}

/// Names a variable's interface slot; empty if the variable is not part of the interface.
std::string Module::place(std::uint32_t variable, std::uint32_t storage) const {
    const auto with = [&](std::string text, Decoration which, const char* more = "") {
        const std::uint32_t* number = decoration(variable, which);
        if (number == nullptr || (*more != '\0' && *number == 0)) return text;
        return text.append(more).append(std::to_string(*number));
    };
    switch (storage) {
        case push:
            return "push constants";
        case input:
        case output:
            if (decoration(variable, location) == nullptr) return {};
            return with(with(storage == input ? "input " : "output ", location), component, ".");
        case uniform_constant:
        case uniform:
        case buffer:
            return with(with("binding ", binding), set, " of set ");
        default:
            return {};
    }
}

Result<Interface> Module::read(Words words) {
    constexpr std::size_t kHeader = 5;
    const Error broken{ErrorCode::malformed, "no SPIR-V"};
    if (words.size() < kHeader || words[0] != 0x07230203) return broken;
    Module module;
    Interface out;
    std::vector<Words> modes, variables;
    for (std::size_t at = kHeader; at < words.size();) {
        const std::uint32_t operation = words[at] & 0xffffU, size = words[at] >> 16;
        if (size == 0 || size > words.size() - at) return broken;
        const Words rest = words.subspan(at + 1, size - 1);
        at += size;
        if (operation == op_function) break;  // all declarations precede the first function
        if (rest.size() < 2) {
            if (operation == op_capability && rest.size() == 1) out.capabilities.insert(rest[0]);
            if (operation >= op_first_type && operation <= op_last_type && rest.size() == 1) {
                module.definitions_[rest[0]] = rest;
                module.operations_[rest[0]] = operation;
            }
            continue;
        }
        if (operation == op_entry_point) {
            out.stage = rest[0];
        } else if (operation == op_execution_mode || operation == op_execution_mode_id) {
            modes.push_back(rest);
        } else if (operation == op_decorate) {
            module.decorations_[rest[0]].push_back(rest.subspan(1));
        } else if (operation == op_member_decorate && rest.size() > 2) {
            module.of_members_[rest[0]][rest[1]].push_back(rest.subspan(2));
        } else if (operation >= op_first_type && operation <= op_last_type) {
            module.definitions_[rest[0]] = rest;
            module.operations_[rest[0]] = operation;
        } else if (operation == op_constant || operation == op_spec_constant) {
            module.definitions_[rest[1]] = rest;
        } else if (operation == op_variable && rest.size() > 2) {
            variables.push_back(rest);
        }
    }
    for (const Words& mode : modes) {
        if (mode[1] == kLocalSize) out.places["the workgroup's size"] = numbers(mode.subspan(2));
        if (mode[1] == kLocalSizeId) {
            std::string& text = out.places["the workgroup's size"];
            for (const std::uint32_t id : mode.subspan(2)) text += module.value_text(id);
        }
        if (contains(kPrimitives, mode[1])) out.places["what is emitted"] += numbers(mode.subspan(1)) + ";";
    }
    for (const Words& variable : variables) {
        const std::uint32_t pointer = variable[0], id = variable[1], storage = variable[2];
        const auto definition = module.definitions_.find(pointer);
        if (definition == module.definitions_.end() || definition->second.size() < 3) return broken;
        const std::uint32_t type = definition->second[2];
        if (module.decoration(id, built_in_value) != nullptr || module.is_built_in(type)) continue;
        const std::string where = module.place(id, storage);
        if (where.empty()) continue;
        out.places[where] += std::to_string(storage) +
                             (module.decoration(id, non_writable) != nullptr ? " read " : " ") + module.type_text(type);
    }
    return out;
}

}  // namespace

Result<void> check_interface(const Shader& built_in, std::span<const std::uint32_t> words) {
    const Result<Interface> read_then = Module::read(built_in.words), read_now = Module::read(words);
    if (!read_then) return read_then.error();
    if (!read_now) return read_now.error();
    const Interface &then = *read_then, &now = *read_now;
    const auto wrong = [](const std::string& why) {
        return Error{ErrorCode::unsupported, why + ": the program must be built anew for that"};
    };
    if (then.stage != now.stage) return wrong("the stage is another");
    for (const std::uint32_t one : now.capabilities) {
        if (contains(kAlways, one) || then.capabilities.contains(one)) continue;
        return wrong("SPIR-V capability " + std::to_string(one) + " was not asked of the device");
    }
    for (const auto& [where, what] : now.places) {
        const auto before = then.places.find(where);
        if (before == then.places.end()) return wrong(where + " is new");
        if (before->second != what) return wrong(where + " is declared otherwise");
    }
    for (const auto& [where, what] : then.places) {
        const bool needed = where.starts_with("output") || where.starts_with("the ") || where.starts_with("what ");
        if (needed && !now.places.contains(where)) return wrong(where + " is missing");
    }
    return {};
}

}  // namespace lacedring::gpu
