# Installs the build into a new folder, builds examples/ against it in every way that docs/install.md names, and runs them.
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DLACEDRING=... -DNINJA=... -DCXX=... -P check.cmake      SOURCE: the repository
function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE error)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${ARGN}: ${code}\n${out}${error}")
    endif()
    set(out "${out}" PARENT_SCOPE)
endfunction()
function(expect wanted)
    if(NOT out MATCHES "${wanted}")
        message(FATAL_ERROR "'${out}' is not '${wanted}'")
    endif()
endfunction()
set(encode_prints "^[0-9]+ words, 12 indices\n$")
set(no_packages -G Ninja -DCMAKE_MAKE_PROGRAM=${NINJA} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF
                -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# What is installed: the headers that are public, and no others.
file(GLOB headers RELATIVE ${WORK}/prefix/include/lacedring ${WORK}/prefix/include/lacedring/*)
set(public base.hpp corner_walks.hpp file.hpp lacedring.h lacedring.hpp lacedring_decode.h lacedring_seams.h lacedring_storage.h lacedring_stored_seams.h lacedring_vertices.h lr_file.hpp materials.hpp mesh.hpp mesh_files.hpp operators.hpp primitives.hpp ring.hpp scene.h scene.hpp
           seams.hpp streams.hpp surface.hpp topology.hpp vertices.hpp)
if(NOT headers STREQUAL public)
    message(FATAL_ERROR "installed headers: ${headers}")
endif()
file(GLOB license ${WORK}/prefix/share/doc/*/LICENSE)
if(NOT license)
    message(FATAL_ERROR "no LICENSE is installed")
endif()

# find_package, core and io.
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/examples -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/examples)
run(${WORK}/examples/encode)
expect("${encode_prints}")
run(${LACEDRING} encode --resident ${SOURCE}/assets/blob.ply -o ${WORK}/packed.lr)
run(${LACEDRING} encode ${SOURCE}/assets/blob.ply -o ${WORK}/stored.lr)
run(${LACEDRING} encode ${SOURCE}/assets/cut_torus.ply -o ${WORK}/tables.lr --format lr)
run(${WORK}/examples/decode ${WORK}/packed.lr)
string(REGEX MATCHALL "\nf [^\n]*" decoded "${out}")
run(${LACEDRING} decode ${WORK}/packed.lr -o ${WORK}/packed.obj)
file(READ ${WORK}/packed.obj out)
string(REGEX MATCHALL "\nf [^\n]*" wanted "${out}")
list(LENGTH wanted count)
if(NOT decoded STREQUAL wanted OR NOT count EQUAL 12000)
    message(FATAL_ERROR "examples/decode.c: other triangles than lacedring decode, or not 12000 but ${count}")
endif()
run(${WORK}/examples/adjacency ${WORK}/tables.lr ${WORK}/smooth.ply)
run(${LACEDRING} info ${WORK}/smooth.ply)
expect("triangles +8688\n.*borders +104 edges in 2 loops")
foreach(bad IN ITEMS ${WORK}/packed.lr ${WORK}/stored.lr ${WORK}/missing.lr ${SOURCE}/README.md)
    execute_process(COMMAND ${WORK}/examples/adjacency ${bad} ${WORK}/bad.ply RESULT_VARIABLE code OUTPUT_VARIABLE out)
    if(NOT code EQUAL 1 OR NOT out MATCHES "^[^\n]+\n$")
        message(FATAL_ERROR "adjacency ${bad}: ${code} ${out}")
    endif()
endforeach()

# find_package, the core alone, where no other package can be found.
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/core -Dlacedring_DIR=${WORK}/prefix/lib/cmake/lacedring -DWITH_FILES=OFF
    -DCMAKE_C_COMPILER=${CC} ${no_packages})
run(${CMAKE_COMMAND} --build ${WORK}/core)
run(${WORK}/core/encode)
expect("${encode_prints}")
run(${WORK}/core/seams)
expect("^8 vertices, 24 copies, 12 sharp edges\n$")

# add_subdirectory, where no package can be found.
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/subdirectory -B ${WORK}/subdirectory -DLACEDRING=${SOURCE}
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug ${no_packages})
run(${CMAKE_COMMAND} --build ${WORK}/subdirectory)
run(${WORK}/subdirectory/encode)
expect("${encode_prints}")
run(${CMAKE_COMMAND} --install ${WORK}/subdirectory --prefix ${WORK}/other)
file(GLOB_RECURSE installed RELATIVE ${WORK}/other ${WORK}/other/*)
if(NOT installed STREQUAL "bin/encode")
    message(FATAL_ERROR "as a folder of another project it installs ${installed}")
endif()

# pkg-config.
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/lib/pkgconfig)
run(pkg-config --cflags --libs lacedring)
string(STRIP "${out}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${CXX} -std=c++20 ${SOURCE}/examples/encode.cpp -o ${WORK}/by_pkg_config ${flags})
run(${WORK}/by_pkg_config)
expect("${encode_prints}")
run(${CC} -std=c99 ${SOURCE}/tests/c/c_interface.c -o ${WORK}/c_by_pkg_config ${flags})
run(${WORK}/c_by_pkg_config)

# The core installed alone: a package without io.
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/alone -DLACEDRING_IO=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug ${no_packages})
run(${CMAKE_COMMAND} --build ${WORK}/alone)
run(${CMAKE_COMMAND} --install ${WORK}/alone --prefix ${WORK}/alone_prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/alone -B ${WORK}/find -Dlacedring_DIR=${WORK}/alone_prefix/lib/cmake/lacedring ${no_packages})
