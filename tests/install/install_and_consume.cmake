# cmake -DBUILD=... -DSOURCE=... -DSCRATCH=... -DCONFIG=... -P install_and_consume.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "failed with ${status}: ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix --config ${CONFIG})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer ${SCRATCH}/sphere.vtu)
if(NOT EXISTS ${SCRATCH}/sphere.vtu)
  message(FATAL_ERROR "the consumer wrote no mesh")
endif()

# Of the mesher alone a program needs no zlib and no HDF5.
run(${CMAKE_COMMAND} -S ${SOURCE}/../arrays -B ${SCRATCH}/arrays -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --build ${SCRATCH}/arrays)
run(${SCRATCH}/arrays/arrays)
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${SCRATCH}/arrays/arrays RESOLVED_DEPENDENCIES_VAR needed)
list(FILTER needed INCLUDE REGEX "/lib(z|hdf5)[^/]*[.]so")
if(needed)
  message(FATAL_ERROR "a program of octafront::mesher needs ${needed}")
endif()
run(${CMAKE_CURRENT_LIST_DIR}/pkg_config.sh ${SCRATCH}/prefix ${EXAMPLES} ${SCRATCH}/pkg_config)
