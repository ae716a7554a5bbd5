# cpack -G DEB: octafront_*.deb with the tool, liboctafront-dev_*.deb with what programs of others are built with,
# octafront-cad_*.deb with what reads CAD, which brings OpenCASCADE along. Of shared libraries also liboctafront0_*.deb, and with
# OCTAFRONT_DEBIAN_PYTHON python3-octafront_*.deb and octafront-doc_*.deb: scripts/packages.sh.
set(components runtime development)
set(packages octafront liboctafront-dev)
if(TARGET octafront_cad_program)
  list(APPEND components cad)
  list(APPEND packages octafront-cad)
endif()
if(BUILD_SHARED_LIBS)
  get_target_property(soversion octafront SOVERSION)
  set(library_package liboctafront${soversion})
  list(APPEND components library)
  list(APPEND packages ${library_package})
endif()

if(OCTAFRONT_DEBIAN_PYTHON)
  list(APPEND components python doc)
  list(APPEND packages python3-octafront octafront-doc)
  # What the wheel has inside are links to what the system has.
  set(dist_packages lib/python3/dist-packages)
  install(DIRECTORY python/octafront DESTINATION ${dist_packages} COMPONENT python PATTERN __pycache__ EXCLUDE PATTERN _bin EXCLUDE)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/python-metadata CONTENT
       "Metadata-Version: 2.1\nName: octafront\nVersion: ${PROJECT_VERSION}\nSummary: ${PROJECT_DESCRIPTION}\nLicense: Apache-2.0\n")
  install(FILES ${PROJECT_BINARY_DIR}/python-metadata DESTINATION ${dist_packages} RENAME octafront-${PROJECT_VERSION}.egg-info
          COMPONENT python)
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${dist_packages}/octafront/_bin
             OUTPUT_VARIABLE to_library)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${dist_packages}/octafront/_bin\")
    file(MAKE_DIRECTORY \${folder})
    file(CREATE_LINK ${to_library}/liboctafront.so.${soversion} \${folder}/liboctafront.so SYMBOLIC)
    file(CREATE_LINK ../../../../../bin/octafront \${folder}/octafront SYMBOLIC)" COMPONENT python)
  install(DIRECTORY docs/ DESTINATION ${doc_dir}/octafront-doc COMPONENT doc PATTERN api EXCLUDE)
  install(DIRECTORY examples samples DESTINATION ${doc_dir}/octafront-doc COMPONENT doc PATTERN CMakeLists.txt EXCLUDE
          PATTERN __pycache__ EXCLUDE)
endif()

set(CPACK_PACKAGE_NAME octafront)
set(CPACK_PACKAGE_VENDOR "The Octafront authors")
set(CPACK_PACKAGE_CONTACT "The Octafront authors <octafront@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Of one build, to one another: as exactly this version.
set(same "(= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME octafront)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Tetrahedral finite element meshes from closed surfaces: command line tool")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS octafront-cad)
set(CPACK_DEBIAN_CAD_PACKAGE_NAME octafront-cad)
set(CPACK_DEBIAN_CAD_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_CAD_DESCRIPTION "Tetrahedral finite element meshes: reader of STEP, IGES and BREP")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liboctafront-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(dev_depends libtbb-dev libfmt-dev zlib1g-dev)
if(OCTAFRONT_HDF5_LIBRARY)
  list(APPEND dev_depends libhdf5-dev)
endif()
if(OCTAFRONT_GDCM_LIBRARIES)
  list(APPEND dev_depends libgdcm-dev)
endif()
if(OCTAFRONT_TIFF_LIBRARY)
  list(APPEND dev_depends libtiff-dev)
endif()
if(OCTAFRONT_METIS_LIBRARY)
  list(APPEND dev_depends libmetis-dev)
endif()
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Tetrahedral finite element meshes from closed surfaces: C++ and C library")

if(BUILD_SHARED_LIBS)
  list(PREPEND dev_depends "${library_package} ${same}")
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
  # What packages of others that link it depend on; there is no such variable of a component.
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
  set(CPACK_POST_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/triggers.cmake)
  set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Tetrahedral finite element meshes from closed surfaces: shared libraries")
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "${library_package} ${same}")
  set(CPACK_DEBIAN_CAD_PACKAGE_RECOMMENDS "octafront ${same}")
endif()
list(JOIN dev_depends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)

if(OCTAFRONT_DEBIAN_PYTHON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-octafront)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${library_package} ${same}, python3:any, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "octafront ${same}")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Tetrahedral finite element meshes from closed surfaces: Python package")
  # Compiled when it is installed, and nothing of that left when it goes.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/postinst @ONLY CONTENT "#!/bin/sh
set -e
if [ \"$1\" = configure ] && command -v py3compile >/dev/null; then py3compile -p python3-octafront; fi
")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/prerm @ONLY CONTENT "#!/bin/sh
set -e
if command -v py3clean >/dev/null; then py3clean -p python3-octafront; fi
")
  file(CHMOD ${PROJECT_BINARY_DIR}/debian/postinst ${PROJECT_BINARY_DIR}/debian/prerm
       PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/debian/postinst;${PROJECT_BINARY_DIR}/debian/prerm")
  set(CPACK_DEBIAN_DOC_PACKAGE_NAME octafront-doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
  set(CPACK_COMPONENT_DOC_DESCRIPTION "Tetrahedral finite element meshes: pages, examples and samples")
endif()

# What a Debian package has to say of itself.
if(OCTAFRONT_GZIP)
  set(debian_dir ${PROJECT_BINARY_DIR}/debian)
  string(TIMESTAMP changelog_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  configure_file(cmake/debian/changelog.in ${debian_dir}/changelog @ONLY)
  add_custom_command(OUTPUT ${debian_dir}/changelog.gz COMMAND ${OCTAFRONT_GZIP} -9nkf ${debian_dir}/changelog
                     DEPENDS ${debian_dir}/changelog)
  add_custom_target(octafront_debian_files ALL DEPENDS ${debian_dir}/changelog.gz)
  foreach(component package IN ZIP_LISTS components packages)
    install(FILES cmake/debian/copyright ${debian_dir}/changelog.gz DESTINATION ${doc_dir}/${package} COMPONENT ${component})
    if(component MATCHES "^(library|python|doc)$")
      install(FILES LICENSE NOTICE DESTINATION ${doc_dir}/${package} COMPONENT ${component})
      install(DIRECTORY licenses DESTINATION ${doc_dir}/${package} COMPONENT ${component})
    endif()
  endforeach()
endif()
include(CPack)
