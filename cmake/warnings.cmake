# An interface library with the project's warnings and sanitizers, linked privately by every target of ours.
add_library(lacedring_options INTERFACE)
target_compile_options(lacedring_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor)
if(LACEDRING_WERROR)
    target_compile_options(lacedring_options INTERFACE -Werror)
endif()
if(LACEDRING_SANITIZE)
    target_compile_options(lacedring_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                       -fno-omit-frame-pointer)
    target_link_options(lacedring_options INTERFACE -fsanitize=address,undefined)
    target_compile_definitions(lacedring_options INTERFACE LACEDRING_SANITIZE)
endif()
if(LACEDRING_FUZZ)  # the standard library's own bounds checks, too
    target_compile_definitions(lacedring_options INTERFACE _GLIBCXX_ASSERTIONS)
    target_compile_options(lacedring_options INTERFACE -Wno-bitwise-instead-of-logical)
endif()
