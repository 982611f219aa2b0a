# pcednet_room(NAME [QUICK] USES room... LINKS library... PRIVATE_LINKS library...)
# workbench_room(NAME [QUICK] USES room... LINKS library... PRIVATE_LINKS library...)
#
# Makes the library target pcednet_NAME (alias pcednet::NAME, workbench::NAME) from every source of
# the current folder; a room within another is named io/las, its target pcednet_io_las. USES names
# the rooms whose headers it includes; LINKS are outside libraries that appear in its headers,
# PRIVATE_LINKS those that appear only in its sources, other than fmt, which writes every room's
# messages. A QUICK room takes little of the time of any run, and is compiled for a quick build.
# Rooms of the library are installed, as part of the package's component PCEDNET_COMPONENT; those
# of the workbench are not.
function(pcednet_room name)
  pcednet_make_room(${name} pcednet ${ARGN})
  string(REPLACE "/" "_" flat ${name})
  set(target pcednet_${flat})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${flat})
  install(TARGETS ${target} EXPORT ${PCEDNET_COMPONENT}Targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endfunction()

function(workbench_room name)
  pcednet_make_room(${name} workbench ${ARGN})
endfunction()

function(pcednet_make_room name wing)
  cmake_parse_arguments(room "QUICK" "" "USES;LINKS;PRIVATE_LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  string(REPLACE "/" "_" flat ${name})
  set(target pcednet_${flat})
  add_library(${target} STATIC ${sources} ${headers})
  add_library(${wing}::${flat} ALIAS ${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  pcednet_compile_options(${target})
  if(room_QUICK)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
    pcednet_precompile(${target} pcednet_formats <nlohmann/json.hpp>)
  else()
    pcednet_precompile(${target} pcednet_core)
  endif()
  string(REPLACE "/" "_" used_rooms "${room_USES}")
  foreach(used ${used_rooms})
    target_link_libraries(${target} PUBLIC pcednet_${used})
  endforeach()
  # Who uses the installed room need not have what is only headers of its sources.
  list(TRANSFORM room_PRIVATE_LINKS REPLACE "^(nlohmann_json|nanoflann)::.*$" "$<BUILD_INTERFACE:\\0>")
  target_link_libraries(${target} PUBLIC ${room_LINKS} PRIVATE fmt::fmt ${room_PRIVATE_LINKS})
  target_link_libraries(pcednet_rooms INTERFACE ${target})
  add_dependencies(rooms ${target})
endfunction()

# Warnings, and no contraction of a*b+c, so that copies for several instruction sets give the same
# bits. The lane kernels of gls do contract: see docs/architecture.md, Determinism.
function(pcednet_compile_options target)
  # -Wno-restrict: GCC 12 warns of std::string's own code (GCC bug 105329).
  # ggc-*: GCC collects its garbage when it holds a gigabyte, not at every step: a tenth of its time.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;--param=ggc-min-expand=100;--param=ggc-min-heapsize=1048576>
    -ffp-contract=off $<$<BOOL:${PCEDNET_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# pcednet_vector_code(STEM FLAG...): compiles STEM_baseline.cpp, STEM_avx2.cpp and STEM_avx512.cpp of
# the current folder for these instruction sets (core/processor.h), the last two on x86-64 alone, with
# the flags. Each is compiled by itself: see core/simd.h.
function(pcednet_vector_code stem)
  set(baseline "")
  set(avx2 -march=x86-64-v3)
  set(avx512 -march=x86-64-v4 -mprefer-vector-width=512)
  foreach(instructions baseline avx2 avx512)
    set_source_files_properties(${stem}_${instructions}.cpp PROPERTIES
      COMPILE_OPTIONS "${ARGN};${${instructions}}"
      SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set_source_files_properties(${stem}_avx2.cpp ${stem}_avx512.cpp PROPERTIES HEADER_FILE_ONLY ON)
  endif()
endfunction()

# pcednet_precompile(TARGET OWNER header...): with PCEDNET_PRECOMPILE the headers that nearly every
# source includes are parsed once, by OWNER, for all targets that are compiled as it is. What OWNER
# adds to the common ones follows it.
function(pcednet_precompile target owner)
  if(NOT PCEDNET_PRECOMPILE)
    return()
  elseif(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE <Eigen/Geometry> <fmt/format.h> <algorithm> <filesystem>
      <functional> <map> <memory> <numeric> <optional> <span> <string> <vector> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()
