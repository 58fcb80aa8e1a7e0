#include <cstdio>
#include <lacedring/lacedring.hpp>

int main() {
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};  // a tetrahedron
    const auto encoded = lacedring::encode(indices, 4);  // reorder vertex attributes by encoded->vertex_order
    if (!encoded) return std::puts(encoded.error().message.c_str()), 1;
    const auto stream = lacedring::validate(encoded->words);  // only the words need to be stored
    if (!stream) return std::puts(stream.error().message.c_str()), 1;
    const std::vector<std::uint32_t> decoded = lacedring::decode(*stream);
    return std::printf("%zu words, %zu indices\n", encoded->words.size(), decoded.size()) < 0;
}
