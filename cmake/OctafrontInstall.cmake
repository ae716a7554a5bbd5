# `cmake --install`, what find_package(octafront) and pkg-config find, and `cpack -G DEB`. Components: what one runs,
# what programs of others are built with, and what reads CAD, where that was built; of shared libraries also these
# themselves, and with OCTAFRONT_DEBIAN_PYTHON the Python package that stands on them, and the pages.
include(CMakePackageConfigHelpers)
find_program(OCTAFRONT_GZIP gzip)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/octafront)
set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc)
option(OCTAFRONT_DEBIAN_PYTHON "Install the Python package for the system's Python, beside shared libraries, and the pages" OFF)
if(OCTAFRONT_DEBIAN_PYTHON AND NOT BUILD_SHARED_LIBS)
  message(FATAL_ERROR "OCTAFRONT_DEBIAN_PYTHON stands on shared libraries: add -DBUILD_SHARED_LIBS=ON")
endif()
set(library_component runtime)
if(BUILD_SHARED_LIBS)
  set(library_component library)
endif()
# Who asks for the mesher alone need not have what the rest stands on: an export of its own.
set(installed_libraries octafront_mesher octafront)
if(OCTAFRONT_MPI)
  list(APPEND installed_libraries octafront_mpi)
endif()
foreach(library IN LISTS installed_libraries)
  install(TARGETS ${library} EXPORT ${library}Targets
          ARCHIVE COMPONENT development
          LIBRARY COMPONENT ${library_component} NAMELINK_COMPONENT development)
  install(EXPORT ${library}Targets NAMESPACE octafront:: DESTINATION ${package_dir} COMPONENT development)
endforeach()
install(DIRECTORY include/octafront DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(FILES LICENSE NOTICE DESTINATION ${doc_dir}/liboctafront-dev COMPONENT development)
install(DIRECTORY licenses DESTINATION ${doc_dir}/liboctafront-dev COMPONENT development)
if(TARGET octafront_cli)
  install(TARGETS octafront_cli RUNTIME COMPONENT runtime)
  install(FILES LICENSE NOTICE README.md CHANGELOG.md DESTINATION ${doc_dir}/octafront COMPONENT runtime)
  install(DIRECTORY licenses DESTINATION ${doc_dir}/octafront COMPONENT runtime)
endif()

# The page of the workbench, where scripts/ui.sh has made it.
if(TARGET octafront_cli)
  install(FILES ${PROJECT_SOURCE_DIR}/build/ui/octafront-ui.html DESTINATION ${CMAKE_INSTALL_DATADIR}/octafront COMPONENT runtime OPTIONAL)
endif()

# The manual page and what completes commands in shells, which the tool writes itself.
if(TARGET octafront_cli)
  set(shell_dir ${PROJECT_BINARY_DIR}/shell)
  set(manual ${shell_dir}/octafront.1)
  if(OCTAFRONT_GZIP)
    set(manual ${shell_dir}/octafront.1.gz)
    set(compress COMMAND ${OCTAFRONT_GZIP} -9nkf ${shell_dir}/octafront.1)
  endif()
  add_custom_command(OUTPUT ${manual} ${shell_dir}/octafront.bash ${shell_dir}/_octafront ${shell_dir}/octafront.fish
    COMMAND ${CMAKE_COMMAND} -E make_directory ${shell_dir}
    COMMAND octafront_cli help --man > ${shell_dir}/octafront.1
    ${compress}
    COMMAND octafront_cli completion bash > ${shell_dir}/octafront.bash
    COMMAND octafront_cli completion zsh > ${shell_dir}/_octafront
    COMMAND octafront_cli completion fish > ${shell_dir}/octafront.fish
    DEPENDS octafront_cli)
  add_custom_target(octafront_shell_files ALL DEPENDS ${manual})
  install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
  install(FILES ${shell_dir}/octafront.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME octafront
          COMPONENT runtime)
  install(FILES ${shell_dir}/_octafront DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT runtime)
  install(FILES ${shell_dir}/octafront.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT runtime)
endif()

configure_package_config_file(cmake/octafrontConfig.cmake.in octafrontConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(octafrontConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/octafrontConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/octafrontConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)

# pkg-config: from where the file lies, so that the whole prefix may be moved. A static library wants what it stands on
# at every link, also by a C compiler; with a shared one that is private.
set(pc_stands_on ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER pc_stands_on EXCLUDE REGEX "^(gcc|gcc_s|c)$")
list(TRANSFORM pc_stands_on PREPEND "-l" REGEX "^[^-/]")
# By its name where linkers look anyway: then the file is right for every architecture.
set(pc_hdf5 "${OCTAFRONT_HDF5_LIBRARY}")
cmake_path(GET OCTAFRONT_HDF5_LIBRARY PARENT_PATH hdf5_dir)
if(hdf5_dir IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
  string(REGEX REPLACE "^.*/lib([^/]*)[.](so|a)$" "-l\\1" pc_hdf5 "${OCTAFRONT_HDF5_LIBRARY}")
endif()
set(pc_gdcm "")
if(OCTAFRONT_GDCM_LIBRARIES)
  set(pc_gdcm "-lgdcmMSFF -lgdcmDSED -lgdcmCommon")
endif()
if(OCTAFRONT_TIFF_LIBRARY)
  string(APPEND pc_gdcm " -ltiff")
endif()
set(pc_metis "")
if(OCTAFRONT_METIS_LIBRARY)
  set(pc_metis "-lmetis")
endif()
set(pc_tbb "")
if(OCTAFRONT_THREADS)
  set(pc_tbb "tbb ")
  list(PREPEND pc_stands_on -lpthread)
endif()
list(JOIN pc_stands_on " " pc_stands_on)
get_target_property(pc_kind octafront TYPE)
file(RELATIVE_PATH pc_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
# octafront_pc(NAME BROUGHT REQUIRES LIBS): the file of library NAME, whose users link BROUGHT too, and the rest if it
# is static.
function(octafront_pc pc_name pc_brought pc_requires pc_libs)
  if(pc_kind STREQUAL "STATIC_LIBRARY")
    string(APPEND pc_brought " ${pc_requires}")
    set(pc_requires "")
    set(pc_libs_private "")
  else()
    set(pc_libs_private "${pc_libs}")
    set(pc_libs "")
  endif()
  configure_file(cmake/octafront.pc.in ${pc_name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${pc_name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT development)
endfunction()
octafront_pc(octafront_mesher "" "${pc_tbb}fmt" "${pc_stands_on}")
octafront_pc(octafront "octafront_mesher" "fmt zlib" "${pc_hdf5} ${pc_metis} ${pc_gdcm} ${pc_stands_on}")
if(OCTAFRONT_MPI)
  # For mpicxx, which knows where its MPI is.
  octafront_pc(octafront_mpi "octafront_mesher" "" "${pc_stands_on}")
endif()

if(TARGET octafront_cad_program)
  install(FILES LICENSE NOTICE DESTINATION ${doc_dir}/octafront-cad COMPONENT cad)
endif()

include(OctafrontPackages)
