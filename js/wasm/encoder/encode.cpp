// The encoder in WebAssembly: takes arrays, makes the bytes of an .lr file, the same as `lacedring encode` writes. One
// mesh per instance: js/src/encode.js makes an instance for each call. So nothing is freed here, and an instance that
// has trapped affects no other call.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "lacedring/lr_file.hpp"
#include "lrcore/base/parallel.h"
#include "lrcore/base/try.h"

#define LR_EXPORT(name) extern "C" __attribute__((export_name(#name)))

/// Throws an exception in JavaScript; does not return.
extern "C" __attribute__((import_module("lacedring"), import_name("outOfMemory"), noreturn)) void out_of_memory();

// Compiled without exceptions, the library's own operator new would return null.
void* operator new(std::size_t size) {
    if (void* memory = std::malloc(size != 0 ? size : 1)) return memory;
    out_of_memory();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace lacedring {

// Replaces lrcore/base/parallel.cpp: there are no threads here.
void detail::run_parts(unsigned, std::uint32_t parts, void (*call)(void* work, std::uint32_t part), void* work) {
    for (std::uint32_t i = 0; i < parts; ++i) call(work, i);
}

namespace {

Mesh mesh;
std::vector<std::byte> file;
std::string why_not;

Error malformed(std::string why) {
    return {ErrorCode::malformed, std::move(why)};
}

/// The index of the first value that is not finite as a float, or SIZE_MAX.
template <class Real>
std::size_t first_not_finite(const std::vector<std::byte>& data) {
    for (std::size_t i = 0; i * sizeof(Real) < data.size(); ++i) {
        Real value = 0;
        std::memcpy(&value, data.data() + i * sizeof value, sizeof value);
        if (!(std::abs(static_cast<double>(value)) < 0x1.ffffffp127)) return i;
    }
    return SIZE_MAX;
}

/// Checks the invariant of Mesh. JavaScript has checked types and sizes already.
Result<void> check() {
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (mesh.indices[i] >= mesh.vertex_count) return malformed("index " + std::to_string(i) + " names no vertex");
    }
    const Attribute& position = mesh.attributes.front();
    const std::size_t bad = position.type == ComponentType::f64 ? first_not_finite<double>(position.data)
                                                                : first_not_finite<float>(position.data);
    if (bad == SIZE_MAX) return {};
    return malformed("vertex " + std::to_string(bad / 3) +
                     ": the position is not finite, or beyond the range of floats");
}

/// Encodes the mesh to `file`, in the same steps as app/commands/encode.cpp.
Result<void> encode_file(const AttributeBits& bits, std::uint32_t effort, bool keep_order, LrForm form) {
    if (const Result<void> good = check(); !good) return good.error();
    SurfaceReport report;
    Surface surface = find_surface(mesh, 0, &report);
    if (report.moved > 0) move_to_surface(mesh, surface);
    if (!keep_order) mesh = merge_copies(mesh, surface);
    LR_ASSIGN(CornerTable table, surface.has_seams()
                                     ? build_corner_table(surface_mesh(mesh, surface).indices, surface.vertex_count)
                                     : build_corner_table(mesh.indices, mesh.vertex_count));
    if (mesh.triangle_count() == table.topology.degenerate) return malformed("no triangle is left: all are degenerate");
    EncodeOptions options;
    options.effort = effort;
    LR_ASSIGN(Encoded encoded, encode(std::move(table), options));
    LR_ASSIGN(LrFile made, make_lr_file(mesh, surface, std::move(encoded), keep_order));
    LR_TRY(compress_attributes(made, bits));
    file = serialize_lr(made, form);
    return {};
}

}  // namespace
}  // namespace lacedring

using namespace lacedring;

/// Makes room for `count` indices below `vertices`. Returns where JavaScript writes them.
LR_EXPORT(indices) std::uint32_t* indices(std::size_t count, std::uint32_t vertices) {
    mesh.vertex_count = vertices;
    mesh.indices.resize(count);
    return mesh.indices.data();
}

/// Adds an attribute; POSITION comes first. JavaScript then writes its name to name(), and its values to values().
LR_EXPORT(addAttribute)
void add_attribute(std::uint32_t type, std::uint32_t components, bool normalized, bool v_up, std::size_t name_bytes) {
    Attribute& added = mesh.attributes.emplace_back();
    added.type = static_cast<ComponentType>(type);
    added.components = static_cast<std::uint8_t>(components);
    added.normalized = normalized;
    added.v_up = v_up;
    added.name.resize(name_bytes);
    added.data.resize(mesh.vertex_count * added.stride());
}
LR_EXPORT(name) char* name() {
    return mesh.attributes.back().name.data();
}
LR_EXPORT(values) std::byte* values() {
    return mesh.attributes.back().data.data();
}

/// Encodes the mesh. Returns true if result() is the file, false if it is an error message of one line.
LR_EXPORT(encode)
bool encode_mesh(std::uint32_t positions, std::uint32_t normals, std::uint32_t texcoords, std::uint32_t colors,
                 std::uint32_t weights, std::uint32_t effort, bool keep_order, bool resident) {
    AttributeBits bits;
    bits.positions = positions;
    bits.normals = normals;
    bits.texcoords = texcoords;
    bits.colors = colors;
    bits.weights = weights;
    const Result<void> made = encode_file(bits, effort, keep_order, resident ? LrForm::resident : LrForm::stored);
    if (!made) why_not = made.error().message;
    return made.has_value();
}
LR_EXPORT(result) const void* result() {
    return why_not.empty() ? static_cast<const void*>(file.data()) : why_not.data();
}
LR_EXPORT(resultBytes) std::size_t result_bytes() {
    return why_not.empty() ? file.size() : why_not.size();
}
