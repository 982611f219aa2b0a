# Installs the build tree into an empty folder, then configures, builds and runs outside projects
# that know nothing but that folder. The build tree must be built.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix ${WORK_DIR}/prefix)
set(model ${prefix}/share/pcednet/models/general.safetensors)
set(settings -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" -D CMAKE_PREFIX_PATH=${prefix})
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})

# Points in memory, with none of the libraries that files and pages need.
set(absent)
foreach(library pugixml yaml-cpp PNG CLI11 nlohmann_json nanoflann Boost)
  list(APPEND absent -D CMAKE_DISABLE_FIND_PACKAGE_${library}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/house/consumer -B ${WORK_DIR}/consumer ${settings}
    ${absent} -D WANTED_VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer)
run(${WORK_DIR}/consumer/consumer ${VERSION} ${model})

# The example: arrays, and file to file.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/examples -B ${WORK_DIR}/examples ${settings}
    -D CMAKE_DISABLE_FIND_PACKAGE_PROJ=ON)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/examples)
run(${WORK_DIR}/examples/detect_edges ${model})
if(NOT output MATCHES "note: no normals" OR NOT output MATCHES "21600 points: [1-9][0-9]+ sharp")
  message(FATAL_ERROR "detect_edges says: ${output}")
endif()
run(${WORK_DIR}/examples/detect_edges ${model} ${SOURCE_DIR}/examples/building.ply
    ${WORK_DIR}/ours.ply)
run(${prefix}/bin/pcednet classify ${SOURCE_DIR}/examples/building.ply -o ${WORK_DIR}/theirs.ply)
run(${CMAKE_COMMAND} -E compare_files ${WORK_DIR}/ours.ply ${WORK_DIR}/theirs.ply)

run(${prefix}/bin/pcednet --version)
if(NOT output MATCHES "pcednet ${VERSION}")
  message(FATAL_ERROR "the installed pcednet says: ${output}")
endif()
