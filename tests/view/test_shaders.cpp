// Tests compiling shaders at run time: the words equal the build's, errors name a position, and interfaces must not
// change. Needs no device and no window.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>

#include "app/view/session/shader_compiler.h"
#include "renderer/shaders/shader_interface.h"
#include "spirv/all.h"

namespace lacedring::view {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    REQUIRE(stream);
    std::ostringstream out;
    out << stream.rdbuf();
    return std::move(out).str();
}

void write(const fs::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    REQUIRE(stream.flush());
}

const gpu::Shader& built_in(const std::string& name) {
    const auto* at = std::ranges::find(spirv_all, name, &gpu::Shader::name);
    REQUIRE(at != std::end(spirv_all));
    return *at;
}

/// A copy of the shaders to edit.
struct Sources {
    Sources() : from(built_shaders()) {
        REQUIRE(!from.empty());
        folder = fs::temp_directory_path() / ("lacedring-shaders-" + std::to_string(std::random_device{}()));
        fs::copy(from, folder, fs::copy_options::recursive);
        compiler.emplace(folder, from);
    }
    Sources(const Sources&) = delete;
    Sources& operator=(const Sources&) = delete;
    ~Sources() { fs::remove_all(folder); }

    void edit(const std::string& name, const std::string& old_text, const std::string& new_text) const {
        std::string text = text_of(folder / name);
        const std::size_t at = text.find(old_text);
        REQUIRE_MESSAGE(at != std::string::npos, name << " has no " << old_text);
        write(folder / name, text.replace(at, old_text.size(), new_text));
    }
    void restore(const std::string& name) const {
        fs::copy_file(from / name, folder / name, fs::copy_options::overwrite_existing);
    }
    /// The error of the compiler or the interface check; "" if the shader is accepted.
    std::string refused(const std::string& name) {
        files.clear();
        const Result<std::vector<std::uint32_t>> made = compiler->compile(name, files);
        if (!made) return made.error().message;
        const Result<void> fits = gpu::check_interface(built_in(name), *made);
        return fits ? "" : fits.error().message;
    }

    fs::path from, folder;
    std::optional<ShaderCompiler> compiler;
    std::map<std::string, Stamp> files;
};

TEST_CASE("unchanged shaders compile to the build's words") {
    Sources sources;
    CHECK(std::size(spirv_all) > 20);
    for (const gpu::Shader& shader : spirv_all) {
        CAPTURE(shader.name);
        const auto made = sources.compiler->compile(std::string(shader.name), sources.files);
        REQUIRE_MESSAGE(made, made.error().message);
        CHECK(std::ranges::equal(*made, shader.words));
        CHECK(gpu::check_interface(shader, *made));
    }
    INFO("included files, also of other folders, are among the files read");
    CHECK(sources.files.contains((sources.folder / "shared.h").string()));
    CHECK(sources.files.contains((sources.from.parent_path() / "lrcore/codec/packed/packed_format.h").string()));
}

TEST_CASE("errors have file and line, and missing includes are watched") {
    Sources sources;
    sources.edit("draw/surface.frag", "#include", "nothing at all;\n#include");
    CHECK(sources.refused("draw/surface.frag").starts_with("shaders/draw/surface.frag:4: "));
    sources.restore("draw/surface.frag");
    sources.edit("draw/surface_vertex.glsl", "v.clip = clip;", "v.clop = clip;");
    for (const char* name : {"draw/surface.vert", "draw/surface_pull.vert"}) {
        const std::string why = sources.refused(name);
        CHECK(why.starts_with("shaders/draw/surface_vertex.glsl:33: "));
        CHECK(why.find("clop") != std::string::npos);
        CHECK(why.find("No code generated") == std::string::npos);
    }
    sources.restore("draw/surface_vertex.glsl");
    sources.edit("draw/surface.frag", "\"shaders/draw/surface.glsl\"", "\"shaders/none.glsl\"");
    CHECK(sources.refused("draw/surface.frag").starts_with("shaders/draw/surface.frag:4: "));
    CHECK(sources.files.contains((sources.folder / "none.glsl").string()));  // it is watched, to compile once it exists
    write(sources.folder / "none.glsl", "#include \"shaders/none.glsl\"\n");
    CHECK(sources.refused("draw/surface.frag").find("includes itself") != std::string::npos);
    fs::remove(sources.folder / "draw/surface.frag");
    CHECK(sources.refused("draw/surface.frag") == "shaders/draw/surface.frag: cannot be read");
    sources.edit("draw/line.frag", "void main()", "void mine()");
    CHECK(sources.refused("draw/line.frag").starts_with("shaders/draw/line.frag: "));
    CHECK(sources.refused("draw/line.vert").empty());
}

TEST_CASE("edits that change an interface are refused, others are accepted") {
    struct Case {
        const char *file, *before, *after, *shader, *why;
    };
    constexpr Case kCases[] = {
        {"draw/surface.frag", "vec3(0.62, 0.60, 0.565)", "vec3(1, 0, 0)", "draw/surface.frag", ""},
        {"draw/surface.frag", "vec4(srgb(color.x), srgb(color.y), srgb(color.z), 1.0)", "vec4(1)", "draw/surface.frag",
         ""},
        {"draw/surface.frag", "in_ring_color;", "in_other;\nvec3 in_ring_color = vec3(1);", "draw/surface.frag", ""},
        {"shared.h", "#define LR_LINE_LIFT 0.0012", "#define LR_LINE_LIFT 0.005", "draw/line.vert", ""},
        {"shared.h", "vec4 line_color;", "vec4 color_of_lines;", "draw/surface.vert", ""},
        {"draw/surface.frag", "binding = 3", "binding = 4", "draw/surface.frag", "binding 4 is new"},
        {"draw/surface.frag", "r32ui) uniform readonly uimage2D", "r32i) uniform readonly iimage2D",
         "draw/surface.frag", "binding 3 is declared otherwise"},
        {"draw/surface.frag", "(location = 2)", "(location = 5)", "draw/surface.frag", "input 5 is new"},
        {"draw/surface.frag", "out vec4 out_color", "out vec3 out_rgb;\nvec4 out_color", "draw/surface.frag",
         "output 0 is declared otherwise"},
        {"draw/surface.frag", "layout(location = 1) out uint", "uint", "draw/surface.frag", "output 1 is missing"},
        {"shared.h", "mat4 view_from_world;", "vec4 more;\n    mat4 view_from_world;", "draw/surface.vert",
         "binding 0 is declared otherwise"},
        {"shared.h", "uint ordered;     // 1", "uint more, ordered;  // 1", "draw/surface_pull.vert",
         "push constants is declared otherwise"},
        {"shared.h", "LR_COMPUTE_GROUP 128u", "LR_COMPUTE_GROUP 64u", "decode/lean_decode.comp",
         "the workgroup's size is declared otherwise"},
        {"shared.h", "LR_MESH_TRIANGLES 64u", "LR_MESH_TRIANGLES 32u", "draw/surface.mesh",
         "output 0 is declared otherwise"},
        {"draw/surface.geom", "max_vertices = 3 * LR_GEOMETRY_SLOTS", "max_vertices = 9", "draw/surface.geom",
         "what is emitted is declared otherwise"},
        {"draw/surface.frag", "out_triangle = (",
         "out_color.x = float(double(out_color.x) * 2.0lf);\n    out_triangle = (", "draw/surface.frag",
         "capability 10 was not asked"},
    };
    Sources sources;
    for (const Case& one : kCases) {
        INFO(std::string(one.file) << ": " << std::string(one.after));
        sources.edit(one.file, one.before, one.after);
        const std::string why = sources.refused(one.shader);
        if (*one.why == '\0') {
            CHECK(why == "");
        } else {
            CHECK_MESSAGE(why.find(one.why) != std::string::npos, why);
        }
        sources.restore(one.file);
        CHECK(sources.refused(one.shader) == "");
    }
}

TEST_CASE("words of another stage and damaged SPIR-V are refused") {
    const gpu::Shader &vertex = built_in("draw/line.vert"), &fragment = built_in("draw/line.frag");
    CHECK(gpu::check_interface(vertex, vertex.words));
    CHECK_FALSE(gpu::check_interface(vertex, fragment.words));
    CHECK_FALSE(gpu::check_interface(vertex, {}));
    std::mt19937 random(3);
    // Random words: a sanitizer reports reads past the end.
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::uint32_t> words(vertex.words.begin(), vertex.words.begin() + random() % vertex.words.size());
        for (int k = 0; k < 3 && !words.empty(); ++k) words[random() % words.size()] ^= 1U << (random() % 32);
        (void)gpu::check_interface(vertex, words);
    }
}

TEST_CASE("half-written shaders are refused or compile, without a crash") {
    Sources sources;
    std::mt19937 random(7);
    std::size_t refused = 0, taken = 0;
    for (const gpu::Shader& shader : spirv_all) {
        const std::string name(shader.name), whole = text_of(sources.from / name);
        CAPTURE(name);
        for (int i = 0; i < 12; ++i) {
            const std::size_t at = random() % whole.size();
            // Cuts the text, removes a piece, or changes a character.
            std::string text = whole.substr(0, at);
            if (i % 3 == 1) text += whole.substr(std::min(whole.size(), at + random() % 60));
            if (i % 3 == 2) text += static_cast<char>(random() % 128) + whole.substr(at + 1);
            CAPTURE(at);
            CAPTURE(i);
            write(sources.folder / name, text);
            const std::string why = sources.refused(name);
            ++(why.empty() ? taken : refused);
            if (!why.empty()) CHECK_MESSAGE(why.find('\0') == std::string::npos, why);
        }
        sources.restore(name);
    }
    CHECK(refused > 100);
    CHECK_MESSAGE(taken > 10, "some half-written shaders are valid");
}

}  // namespace
}  // namespace lacedring::view
