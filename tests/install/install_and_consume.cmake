# cmake -DBUILD=... -DSOURCE=... -DSCRATCH=... -DCONFIG=... -DMPIRUN=... -P install_and_consume.cmake
#   MPIRUN: empty where octafront was built without MPI
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

# Of several processes.
set(ranks ${CMAKE_COMMAND} -S ${SOURCE}/../ranks -B ${SCRATCH}/ranks -DCMAKE_BUILD_TYPE=${CONFIG}
          -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
if(MPIRUN)
  run(${ranks})
  run(${CMAKE_COMMAND} --build ${SCRATCH}/ranks)
  foreach(count 1 2)
    execute_process(COMMAND ${MPIRUN} --allow-run-as-root --oversubscribe --bind-to none -n ${count} ${SCRATCH}/ranks/ranks
                    OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCH "^${count} ranks, ([0-9]+) tetrahedra, (shared|alone)\n$" is_said "${said}")
    list(APPEND made "${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}")
  endforeach()
  if(NOT made MATCHES "^([0-9]+);alone;([0-9]+);shared$" OR NOT CMAKE_MATCH_1 EQUAL CMAKE_MATCH_2)
    message(FATAL_ERROR "1 and 2 processes made ${made}")
  endif()
else()
  execute_process(COMMAND ${ranks} RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE said)
  if(status EQUAL 0 OR NOT said MATCHES "built without MPI")
    message(FATAL_ERROR "octafront::mpi, which is not there, was not refused: ${said}")
  endif()
endif()
run(${CMAKE_CURRENT_LIST_DIR}/pkg_config.sh ${SCRATCH}/prefix ${EXAMPLES} ${SCRATCH}/pkg_config)
