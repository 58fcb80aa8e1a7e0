#pragma once
// The lists of candidates that bench times on the CPU; rivals are among them.

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

/// From an index list to the structures and streams, step by step and as a whole. `subject` must stay where it is.
Candidates construction(const Subject& subject);

/// From streams to index lists, positions and copies. `subject` must stay where it is. Errors: those of encode_vertices
/// and encode_seams, invalid_argument if the rival decodes something else.
Result<Candidates> decoding(const Subject& subject, const VertexOptions& positions);

}  // namespace lacedring::app
