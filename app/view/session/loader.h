#pragma once
// Reads, encodes and measures meshes on threads of its own. A new request stops the one before it, and does not wait
// for it if it is blocked by a disk.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/view/session/document.h"
#include "app/view/session/threads.h"

namespace lacedring::view {

class Loader {
  public:
    /// Other threads call `wake` when a result is ready, but never after the destructor.
    Loader(Threads& threads, std::function<void()> wake);
    /// Stops the current request, without waiting for its thread.
    ~Loader();
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// Reads a file. Results arrive one by one: the mesh with a quick ring, the mesh with the optimized ring and the
    /// packed stream, the LR tables, the formats.
    void open(const Input& input, const RingSettings& settings);
    /// Makes another ring for the same mesh.
    void encode(std::shared_ptr<const Document> document, const RingSettings& settings);
    void cancel();
    /// Lists the meshes in the folder of `path`, on a thread: reading a folder may be as slow as reading a file.
    void list(const std::string& path);

    struct Progress {
        bool busy = false;
        bool background = false;  ///< the user does not wait for it
        std::string what;         ///< name of the current step
        double share = 0;
    };
    Progress progress() const;

    /// Results that arrived since the last take().
    struct Update {
        std::shared_ptr<const Document> document;
        std::shared_ptr<const Tables> tables;
        std::shared_ptr<const app::FormatSet> formats;
        std::optional<std::vector<std::string>> files;  ///< meshes in the folder listed last
        std::optional<std::string> error;               ///< one line, with the file's name
    };
    Update take();
    bool has_update() const;

  private:
    struct Request {
        std::optional<Input> input;
        std::shared_ptr<const Document> document;
        RingSettings settings;
    };
    struct Shared;
    class Job;
    void request(Request request);

    Threads& threads_;
    std::shared_ptr<Shared> shared_;  // shared with the threads
};

}  // namespace lacedring::view
