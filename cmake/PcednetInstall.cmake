include(CMakePackageConfigHelpers)

# pcednet::pcednet links what labels points in memory; pcednet::formats (component formats) adds the
# point files.
add_library(pcednet_all INTERFACE)
add_library(pcednet::pcednet ALIAS pcednet_all)
set_target_properties(pcednet_all PROPERTIES EXPORT_NAME pcednet)
target_link_libraries(pcednet_all INTERFACE pcednet_detect pcednet_lines)
install(TARGETS pcednet_all EXPORT pcednetTargets COMPONENT dev)

# What a program may include: these headers include no others of pcednet, see tests/house.
set(public_headers
  pcednet.h
  cloud/attribute.h cloud/class_table.h cloud/point_cloud.h
  core/error.h core/output_file.h core/parallel.h core/progress.h core/vec3.h
  detect/averages.h detect/boundary.h detect/classify.h detect/model.h detect/points/prepare.h
  detect/result_cloud.h detect/train.h
  formats/read_cloud.h formats/write_cloud.h
  gls/features.h gls/reconstruction.h gls/scale_space_options.h
  io/coordinate_system.h io/drawing/drawing.h io/loaded_cloud.h io/write_options.h
  lines/curves/curve.h lines/find_lines.h lines/points/edge_points.h
  nn/model.h nn/train.h)
foreach(header ${public_headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES src/pcednet/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pcednet/${folder}
          COMPONENT dev)
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pcednet)
install(EXPORT pcednetTargets NAMESPACE pcednet:: DESTINATION ${package_dir} COMPONENT dev)
install(EXPORT pcednet_formatsTargets NAMESPACE pcednet:: DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(cmake/pcednetConfig.cmake.in pcednetConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(pcednetConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pcednetConfig.cmake ${PROJECT_BINARY_DIR}/pcednetConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT dev)
install(DIRECTORY models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/pcednet/models COMPONENT program
        FILES_MATCHING PATTERN "*.safetensors" PATTERN "*.md")
