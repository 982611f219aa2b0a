include(CMakePackageConfigHelpers)
get_property(rooms GLOBAL PROPERTY PCEDNET_ROOMS)

# pcednet::pcednet links every room.
add_library(pcednet_all INTERFACE)
add_library(pcednet::pcednet ALIAS pcednet_all)
set_target_properties(pcednet_all PROPERTIES EXPORT_NAME pcednet)
target_link_libraries(pcednet_all INTERFACE ${rooms})
install(TARGETS pcednet_all EXPORT pcednetTargets)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pcednet)
install(EXPORT pcednetTargets NAMESPACE pcednet:: DESTINATION ${package_dir})
configure_package_config_file(cmake/pcednetConfig.cmake.in pcednetConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(pcednetConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pcednetConfig.cmake ${PROJECT_BINARY_DIR}/pcednetConfigVersion.cmake
        DESTINATION ${package_dir})
install(DIRECTORY models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/pcednet/models
        FILES_MATCHING PATTERN "*.safetensors" PATTERN "*.md")
