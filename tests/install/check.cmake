# Installs the build into a new folder, builds the consumer against it and runs it on a mesh.
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DLACEDRING=... -DNINJA=... -DCXX=... -P check.cmake
function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${ARGN}: ${code}\n${out}")
    endif()
    set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
# The README's example, as it stands.
file(READ ${SOURCE}/../../README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" example "${readme}")
if(NOT example)
    message(FATAL_ERROR "the README has no example in C++")
endif()
file(WRITE ${WORK}/readme.h "${CMAKE_MATCH_1}")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release
    -DEXAMPLE=${WORK})
run(${CMAKE_COMMAND} --build ${WORK}/build)
# The core alone, where no other package can be found.
run(${CMAKE_COMMAND} -S ${SOURCE}/core -B ${WORK}/core -G Ninja -DCMAKE_MAKE_PROGRAM=${NINJA}
    -DCMAKE_CXX_COMPILER=${CXX} -Dlacedring_DIR=${WORK}/prefix/lib/cmake/lacedring
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
run(${CMAKE_COMMAND} --build ${WORK}/core)
run(${WORK}/core/core)
if(NOT out STREQUAL "4 triangles\n")
    message(FATAL_ERROR "the core alone: ${out}")
endif()
run(${LACEDRING} generate torus -o ${WORK}/torus.ply --triangles 2000)
run(${WORK}/build/consumer ${WORK}/torus.ply)
if(NOT out MATCHES "^[0-9]+ slots")
    message(FATAL_ERROR "unexpected output: ${out}")
endif()
execute_process(COMMAND ${WORK}/build/consumer ${WORK}/missing.ply RESULT_VARIABLE code OUTPUT_VARIABLE out)
if(NOT code EQUAL 1 OR NOT out STREQUAL "No such file or directory\n")
    message(FATAL_ERROR "a missing file: ${code} ${out}")
endif()
