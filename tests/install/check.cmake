# Installs the build into a new folder, builds the consumer against it and runs it on a mesh.
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DLACEDRING=... -P check.cmake
function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${ARGN}: ${code}\n${out}")
    endif()
    set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${LACEDRING} generate torus -o ${WORK}/torus.ply --triangles 2000)
run(${WORK}/build/consumer ${WORK}/torus.ply)
if(NOT out MATCHES "^[0-9]+ triangles in [0-9]+ references")
    message(FATAL_ERROR "unexpected output: ${out}")
endif()
