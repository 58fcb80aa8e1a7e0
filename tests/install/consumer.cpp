// Runs the README's example, which check.cmake puts into readme.h.
#include <cstdio>

#include "readme.h"

int main(int argc, char** argv) {
    const auto indices = there_and_back(argc > 1 ? argv[1] : "");
    if (!indices) return std::printf("%s\n", indices.error().message.c_str()), 1;
    std::printf("%zu slots\n", indices->size() / 3);
}
