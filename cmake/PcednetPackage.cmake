# What stands beside the program where it is installed (man pages, completion, desktop entry, icon,
# file types), and the Debian packages that `cpack -G DEB` makes of the build.

set(folder ${PROJECT_SOURCE_DIR}/packaging)
set(share ${CMAKE_INSTALL_DATADIR})
set(made ${PROJECT_BINARY_DIR}/packaging)
# Made by the program just built, so that they say what it does. Only packages need them; a program
# for the thread sanitizer does not run as it is.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND AND CMAKE_BUILD_TYPE STREQUAL "Release")
  string(TIMESTAMP today "%Y-%m-%d" UTC)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.py ${PROJECT_SOURCE_DIR}/models/*.safetensors)
  add_custom_command(
    OUTPUT ${made}/bash/pcednet
    COMMAND Python3::Interpreter ${folder}/make_files.py $<TARGET_FILE:pcednet> ${PROJECT_SOURCE_DIR}
            ${made} --version ${PROJECT_VERSION} --date ${today}
    DEPENDS pcednet ${sources} ${PROJECT_SOURCE_DIR}/docs/command-line.md VERBATIM)
  add_custom_target(pcednet_manual ALL DEPENDS ${made}/bash/pcednet)
  install(DIRECTORY ${made}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${made}/bash/pcednet DESTINATION ${share}/bash-completion/completions
          COMPONENT program)
  install(FILES ${made}/zsh/_pcednet DESTINATION ${share}/zsh/vendor-completions COMPONENT program)
endif()

install(FILES ${folder}/pcednet.desktop DESTINATION ${share}/applications COMPONENT program)
install(FILES ${folder}/pcednet.svg DESTINATION ${share}/icons/hicolor/scalable/apps
        COMPONENT program)
install(FILES ${folder}/pcednet.xml DESTINATION ${share}/mime/packages COMPONENT program)

# pcednet-fee is under the GPL and needs CGAL: who wants it builds it.
set(CPACK_COMPONENTS_ALL program dev)
set(name_of_program pcednet)
set(name_of_dev libpcednet-dev)
get_cmake_property(components COMPONENTS)
if(python IN_LIST components)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(name_of_python python3-pcednet)
endif()

# Empty: each package has its own.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGE_VENDOR "The pcednet authors")
set(PCEDNET_MAINTAINER "The pcednet authors <authors@pcednet.invalid>" CACHE STRING
    "Maintainer of the Debian packages, with an address")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${PCEDNET_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1+deb12)  # it needs the libraries of Debian 12
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "xdg-utils")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "find edges in 3D point clouds
pcednet labels every point of a point cloud as non-edge, smooth-edge,
sharp-edge or boundary, with confidences, and draws the edges as curves for
CAD and GIS. It reads PLY, PCD, OBJ, STL, LAS, LAZ, COPC, E57 and text.

In the browser you paint your own idea of an edge, and a model learns it.
The package contains the trained models.")

set(version_of_packages "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libtbb-dev, libfmt-dev, libpugixml-dev, libssl-dev")
if(SQLite3_FOUND)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libsqlite3-dev")
endif()
if(PCEDNET_LINKS_PROJ)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libproj-dev")
elseif(PCEDNET_PROJ_LIBRARY)  # no program is linked to it
  string(REGEX REPLACE "\\.so\\." "" proj_package ${PCEDNET_PROJ_LIBRARY})
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", ${proj_package}")
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS ${proj_package})
endif()
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "pcednet (= ${version_of_packages})")
set(CPACK_DEBIAN_DEV_DESCRIPTION "find edges in 3D point clouds (development files)
Headers and static libraries of pcednet, which labels every point of a point
cloud as non-edge, smooth-edge, sharp-edge or boundary.

CMake finds them as the package pcednet. The trained models are in the
package pcednet.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
if(proj_package)
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", ${proj_package}")
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "find edges in 3D point clouds (Python)
Python module of pcednet, which labels every point of a point cloud as
non-edge, smooth-edge, sharp-edge or boundary: NumPy arrays in, arrays out.")

# Each package has its copyright and its changelogs.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
find_program(PCEDNET_GZIP gzip)
foreach(component ${CPACK_COMPONENTS_ALL})
  set(package ${name_of_${component}})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  set(docs ${share}/doc/${package})
  install(FILES ${folder}/copyright DESTINATION ${docs} COMPONENT ${component})
  if(PCEDNET_GZIP)
    set(changelogs ${made}/doc/${package})
    file(WRITE ${changelogs}/changelog.Debian
         "pcednet (${version_of_packages}) unstable; urgency=medium\n\n"
         "  * Made from pcednet ${PROJECT_VERSION}.\n\n -- ${PCEDNET_MAINTAINER}  ${now}\n")
    file(COPY ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${changelogs})
    file(RENAME ${changelogs}/CHANGELOG.md ${changelogs}/changelog)
    execute_process(COMMAND ${PCEDNET_GZIP} -9nf ${changelogs}/changelog.Debian ${changelogs}/changelog)
    install(FILES ${changelogs}/changelog.Debian.gz ${changelogs}/changelog.gz DESTINATION ${docs}
            COMPONENT ${component})
  endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/
        DESTINATION ${share}/doc/${name_of_dev}/examples COMPONENT dev
        FILES_MATCHING PATTERN "*.cpp" PATTERN "CMakeLists.txt" PATTERN large EXCLUDE)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # cpack packs what has been built
include(CPack)
