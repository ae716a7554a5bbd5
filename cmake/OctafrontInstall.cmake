# `cmake --install` and what find_package(octafront) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/octafront)
install(TARGETS octafront EXPORT octafrontTargets)
install(EXPORT octafrontTargets NAMESPACE octafront:: DESTINATION ${package_dir})
install(DIRECTORY include/octafront DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/octafront)
if(TARGET octafront_cli)
  install(TARGETS octafront_cli)
endif()

configure_package_config_file(cmake/octafrontConfig.cmake.in octafrontConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(octafrontConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/octafrontConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/octafrontConfigVersion.cmake
        DESTINATION ${package_dir})
