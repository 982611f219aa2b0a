# One program without shared libraries (preset static), which runs on any x86-64 Linux. Of the
# libraries that Debian has as shared ones only, scripts/package.sh builds static ones into
# PCEDNET_STATIC_LIBRARIES; threads are plain, for a static TBB is not supported by its makers.
set(PCEDNET_STATIC_LIBRARIES ${PROJECT_SOURCE_DIR}/build/static-libraries CACHE PATH
    "Where libfmt.a and libproj.a are")
set(CMAKE_EXE_LINKER_FLAGS "${CMAKE_EXE_LINKER_FLAGS} -static-pie")
set(CMAKE_SKIP_RPATH ON)  # a static program that has one ends before main()
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
set(OPENSSL_USE_STATIC_LIBS ON)

# pcednet_make_static(TARGET NAME LIBRARY...): the imported TARGET becomes libNAME.a, which needs the
# libraries.
function(pcednet_make_static target name)
  find_library(PCEDNET_STATIC_${name} ${name} REQUIRED NAMES_PER_DIR HINTS ${PCEDNET_STATIC_LIBRARIES})
  foreach(build NONE RELEASE RELWITHDEBINFO)
    set_target_properties(${target} PROPERTIES IMPORTED_LOCATION_${build} ${PCEDNET_STATIC_${name}})
  endforeach()
  set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${PCEDNET_STATIC_${name}}
                        INTERFACE_LINK_LIBRARIES "${ARGN}")
endfunction()

# To be called when all packages have been found.
function(pcednet_make_all_static)
  pcednet_make_static(fmt::fmt fmt)
  pcednet_make_static(yaml-cpp yaml-cpp)
  pcednet_make_static(pugixml::shared pugixml)
  pcednet_make_static(PROJ::proj proj SQLite::SQLite3 m)
  set_property(TARGET SQLite::SQLite3 APPEND PROPERTY INTERFACE_LINK_LIBRARIES m)
endfunction()
