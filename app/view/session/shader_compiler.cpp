#include "app/view/session/shader_compiler.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "lacedring/file.hpp"

namespace lacedring::view {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kDepth = 40;  // deeper includes are taken for a cycle

std::optional<std::string> read(const fs::path& file, std::map<std::string, Stamp>& files) {
    // Take the stamp before reading, so that a write in between is noticed the next time.
    files[file.string()] = stamp_of(file);
    constexpr std::uint64_t kMost = std::uint64_t{16} << 20;  // no shader is that long
    const Result<std::vector<std::byte>> bytes = read_file(file, kMost);
    if (!bytes) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

class Includer : public glslang::TShader::Includer {
  public:
    Includer(const fs::path& folder, const fs::path& built_from, std::map<std::string, Stamp>& files)
        : folder_(folder), built_from_(built_from), files_(files) {}

    IncludeResult* includeLocal(const char* header, const char* includer, std::size_t depth) override {
        return include(header, includer, depth);
    }
    IncludeResult* includeSystem(const char* header, const char* includer, std::size_t depth) override {
        return include(header, includer, depth);
    }
    void releaseInclude(IncludeResult* result) override {
        if (result == nullptr) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    IncludeResult* include(const std::string& header, const char*, std::size_t depth) {
        if (depth > kDepth) return fail("includes itself");
        std::vector<fs::path> places;
        constexpr std::string_view kOurs = "shaders/";
        if (header.starts_with(kOurs)) {
            places = {folder_ / header.substr(kOurs.size())};
        } else {
            places = {folder_.parent_path() / header};
            if (!built_from_.empty()) places.push_back(built_from_.parent_path() / header);
        }
        for (const fs::path& place : places) {
            if (std::optional<std::string> text = read(place, files_)) {
                auto* kept = new std::string(std::move(*text));
                return new IncludeResult(header, kept->data(), kept->size(), kept);
            }
        }
        return fail("cannot be read");
    }
    static IncludeResult* fail(const char* why) {
        auto* kept = new std::string(why);
        return new IncludeResult("", kept->data(), kept->size(), kept);
    }

    const fs::path &folder_, &built_from_;
    std::map<std::string, Stamp>& files_;
};

std::optional<EShLanguage> stage_of(const fs::path& name) {
    static const std::map<std::string, EShLanguage> kStages{{".vert", EShLangVertex},
                                                            {".frag", EShLangFragment},
                                                            {".geom", EShLangGeometry},
                                                            {".mesh", EShLangMesh},
                                                            {".comp", EShLangCompute}};
    const auto at = kStages.find(name.extension().string());
    return at == kStages.end() ? std::nullopt : std::optional(at->second);
}

/// The errors of a log without duplicate lines. Adds the file's name where glslang gives none.
Error errors(const std::string& file, const std::string& log) {
    constexpr std::string_view kError = "ERROR: ";
    std::string out;
    std::set<std::string> said;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(kError)) continue;
        line.erase(0, kError.size());
        if (line.find("compilation errors.  No code generated") != std::string::npos) continue;
        if (line.find("compilation terminated") != std::string::npos) continue;
        const bool placed = line.find(':') != std::string::npos && line.find('/') < line.find(':');
        if (!placed) line.insert(0, file + ": ");
        if (said.insert(line).second) out += (out.empty() ? "" : "\n") + line;
    }
    return {ErrorCode::malformed, out.empty() ? file + ": glslang refuses it without an error message" : out};
}

}  // namespace

Stamp stamp_of(const fs::path& file) {
    std::error_code error;
    Stamp out{fs::last_write_time(file, error), 0};
    if (error) return {};
    out.size = fs::file_size(file, error);
    return error ? Stamp{} : out;
}

ShaderCompiler::ShaderCompiler(fs::path folder, fs::path built_from)
    : folder_(std::move(folder)), built_from_(std::move(built_from)) {
    glslang::InitializeProcess();
}

ShaderCompiler::~ShaderCompiler() {
    glslang::FinalizeProcess();
}

Result<std::vector<std::uint32_t>> ShaderCompiler::compile(const std::string& name,
                                                           std::map<std::string, Stamp>& files) {
    const std::string file = "shaders/" + name;
    const std::optional<EShLanguage> stage = stage_of(name);
    if (!stage) return Error{ErrorCode::unsupported, file + ": no shader stage has this extension"};
    const std::optional<std::string> text = read(folder_ / name, files);
    if (!text) return Error{ErrorCode::malformed, file + ": cannot be read"};

    // The same settings as glslangValidator -V --target-env vulkan1.3, for the same words.
    constexpr auto kMessages = static_cast<EShMessages>(EShMsgDefault | EShMsgSpvRules | EShMsgVulkanRules);
    glslang::TShader shader(*stage);
    const char* string = text->data();
    const int length = static_cast<int>(text->size());
    const char* string_name = file.c_str();
    shader.setStringsWithLengthsAndNames(&string, &length, &string_name, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, *stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    Includer includer(folder_, built_from_, files);
    if (!shader.parse(GetDefaultResources(), 100, false, kMessages, includer)) {
        return errors(file, shader.getInfoLog());
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages) || !program.mapIO()) return errors(file, program.getInfoLog());
    std::vector<std::uint32_t> words;
    spv::SpvBuildLogger log;
    glslang::SpvOptions options;
    glslang::GlslangToSpv(*program.getIntermediate(*stage), words, &log, &options);
    if (words.empty()) return errors(file, log.getAllMessages());
    return words;
}

fs::path built_shaders() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    fs::path out = fs::canonical(self.parent_path() / "lacedring-shaders", error);
    return error || !fs::is_directory(out, error) ? fs::path{} : out;
}

}  // namespace lacedring::view
