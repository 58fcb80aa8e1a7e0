#include "app/view/session/shader_watch.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <set>

#include "app/view/session/shader_compiler.h"
#include "renderer/shaders/shader_interface.h"
#include "spirv/all.h"

namespace lacedring::view {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, Stamp>;
using gpu::ShaderSet;

constexpr std::chrono::milliseconds kBetweenLooks{150};
// About the time an editor takes to write a file.
constexpr std::chrono::milliseconds kWriting{15};
constexpr int kMostWaits = 20;

/// The thread's state of one shader.
struct Known {
    const gpu::Shader* built_in = nullptr;
    /// The files that it was compiled from; empty: not compiled yet.
    Files files;
    std::string error;                              ///< of the last compilation
    std::shared_ptr<const ShaderSet::Words> words;  ///< null: same as built in
};

bool as_they_were(const Files& files) {
    return std::all_of(files.begin(), files.end(),
                       [](const auto& file) { return stamp_of(file.first) == file.second; });
}

Files files_of(const fs::path& folder) {
    std::error_code error;
    Files out;
    for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        out[at->path().string()] = stamp_of(at->path());
    }
    return out;
}

/// The files of the folder, with a zero stamp (changed) for those newer than the program.
Files built_files(const fs::path& folder) {
    std::error_code error;
    const fs::file_time_type built = fs::last_write_time("/proc/self/exe", error);
    Files out = files_of(folder);
    for (auto& [file, stamp] : out) {
        if (stamp.time > built) stamp = {};
    }
    return out;
}

void compile(ShaderCompiler& compiler, Known& shader) {
    shader.files.clear();
    const std::string name(shader.built_in->name);
    Result<ShaderSet::Words> made = compiler.compile(name, shader.files);
    if (!made) {
        shader.error = made.error().message;
        return;
    }
    if (const Result<void> fits = gpu::check_interface(*shader.built_in, *made); !fits) {
        shader.error = "shaders/" + name + ": " + fits.error().message;
        return;
    }
    shader.error.clear();
    shader.words.reset();
    if (!std::ranges::equal(*made, shader.built_in->words)) {
        shader.words = std::make_shared<const ShaderSet::Words>(std::move(*made));
    }
}

bool same(const ShaderSet::Replaced& a, const ShaderSet::Replaced& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return x.first == y.first && *x.second == *y.second; });
}

/// The first lines of all errors. An error in an included file is listed once, however many shaders include it.
std::string told(const std::vector<Known>& shaders) {
    constexpr std::size_t kLines = 4;
    std::vector<std::string> lines;
    std::set<std::string> said;
    for (const Known& shader : shaders) {
        for (std::size_t at = 0; at < shader.error.size();) {
            const std::size_t end = std::min(shader.error.find('\n', at), shader.error.size());
            std::string line = shader.error.substr(at, end - at);
            if (said.insert(line).second) lines.push_back(std::move(line));
            at = end + 1;
        }
    }
    std::string out;
    for (std::size_t i = 0; i < std::min(kLines, lines.size()); ++i) out += (i != 0 ? "\n" : "") + lines[i];
    if (lines.size() > kLines) out += "\nand " + std::to_string(lines.size() - kLines) + " more";
    return out;
}

}  // namespace

/// State shared by the watch and its thread, which may outlive it.
struct ShaderWatch::Shared {
    Shared(fs::path watched, fs::path built) : folder(std::move(watched)), built_from(std::move(built)) {}

    const fs::path folder, built_from;
    std::mutex mutex;
    std::condition_variable wake;
    Update update;
    std::uint64_t begun = 0;  // checks of the files begun
    bool force = false, quit = false;

    void run();
    void watch();
};

Result<std::unique_ptr<ShaderWatch>> ShaderWatch::create(Threads& threads, fs::path folder, fs::path built_from) {
    auto shared = std::make_shared<Shared>(std::move(folder), std::move(built_from));
    if (const Result<void> started = threads.start([shared] { shared->run(); }); !started) return started.error();
    return std::unique_ptr<ShaderWatch>(new ShaderWatch(std::move(shared)));
}

ShaderWatch::~ShaderWatch() {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->quit = true;
    }
    shared_->wake.notify_all();
}

const fs::path& ShaderWatch::folder() const {
    return shared_->folder;
}

void ShaderWatch::force() {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->force = true;
    }
    shared_->wake.notify_all();
}

ShaderWatch::Update ShaderWatch::take() {
    const std::lock_guard lock(shared_->mutex);
    Update out = shared_->update;
    shared_->update.fresh = shared_->update.changed = false;
    return out;
}

bool ShaderWatch::has_update() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->update.fresh;
}

std::uint64_t ShaderWatch::next_check() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->begun + 1;
}

void ShaderWatch::Shared::run() {
    try {
        watch();
    } catch (const std::bad_alloc&) {
        const std::lock_guard lock(mutex);
        update.fresh = true;
        update.error = "not enough memory to compile shaders: watching them has stopped";
    }
}

void ShaderWatch::Shared::watch() {
    std::vector<Known> shaders;
    for (const gpu::Shader& shader : spirv_all) shaders.push_back({&shader, {}, {}, nullptr});
    // The files that shaders not compiled yet were built from; empty if the program was built from another folder.
    std::optional<Files> built;
    if (folder == built_from) built = built_files(folder);
    // Made when first needed: it has large tables.
    std::optional<ShaderCompiler> compiler;
    for (bool first = true;; first = false) {
        bool forced = false;
        {
            std::unique_lock lock(mutex);
            if (!first) wake.wait_for(lock, kBetweenLooks, [this] { return quit || force; });
            if (quit) return;
            forced = std::exchange(force, false);
            ++begun;
        }
        const bool as_built = built && as_they_were(*built);
        std::vector<Known*> changed;
        for (Known& shader : shaders) {
            const bool fits = shader.files.empty() ? as_built : as_they_were(shader.files);
            if (forced || !fits) changed.push_back(&shader);
        }
        // Wait while files are still being written: a half-written file does not compile.
        for (int i = 0; !changed.empty() && i < kMostWaits; ++i) {
            const Files files = files_of(folder);
            std::this_thread::sleep_for(kWriting);
            if (as_they_were(files)) break;
        }
        for (Known* shader : changed) {
            if (!compiler) compiler.emplace(folder, built_from);
            compile(*compiler, *shader);
            const std::lock_guard lock(mutex);
            ++update.compiled;
            if (quit) return;
        }
        const std::lock_guard lock(mutex);
        ++update.checks;
        if (changed.empty()) continue;
        update.fresh = true;
        update.error = told(shaders);
        if (!update.error.empty()) continue;
        ShaderSet::Replaced replaced;
        for (const Known& shader : shaders) {
            if (shader.words) replaced.emplace(shader.built_in->name, shader.words);
        }
        if (forced || !same(replaced, update.replaced)) update.changed = true;
        update.replaced = std::move(replaced);
    }
}

}  // namespace lacedring::view
