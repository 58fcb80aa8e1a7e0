#pragma once
// The work that bench times on the CPU, rivals included.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "app/bench/subject.h"
#include "lacedring/vertices.hpp"

namespace lacedring::app {

struct Candidates {
    std::vector<Candidate> list;
    std::vector<std::pair<std::string, std::string>> absent = {};  ///< name, reason

    void add(std::string name, std::function<void()> work) {
        list.push_back({std::move(name), std::move(work), {}, {}});
    }
};

/// Building structures and streams from an index list, in steps and as a whole. The candidates refer to `subject`.
Candidates construction(const Subject& subject);

/// Decoding streams to index lists, positions and vertex copies. The candidates refer to `subject`. Errors: those of
/// encode_vertices and encode_seams; invalid_argument if a rival decodes something else.
Result<Candidates> decoding(const Subject& subject, const VertexOptions& positions);

}  // namespace lacedring::app
