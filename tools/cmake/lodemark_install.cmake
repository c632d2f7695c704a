# What `cmake --install` puts where: the library, shared and static, with its header, its CMake package
# and its pkg-config files, and the command. Everything finds everything else relative to itself, so
# that an installed tree may be moved. Needs lodemark, lodemark_static.cmake and, with
# LODEMARK_BUILD_TOOLS, lodemark_command.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lodemark)

install(
  TARGETS lodemark
  EXPORT lodemark
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/core/include/lodemark/lodemark.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodemark)

if(LODEMARK_STATIC_LIBRARY)
  install(FILES ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/liblodemark.a DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()

install(
  EXPORT lodemark
  NAMESPACE lodemark::
  FILE lodemarkTargets.cmake
  DESTINATION ${package_dir})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/lodemarkConfig.cmake.in ${PROJECT_BINARY_DIR}/lodemarkConfig.cmake
  INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lodemarkConfigVersion.cmake
                                 COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lodemarkConfig.cmake
              ${PROJECT_BINARY_DIR}/lodemarkConfigVersion.cmake DESTINATION ${package_dir})

# From the folder of the .pc file back to the prefix.
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir}
     ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
configure_file(${CMAKE_CURRENT_LIST_DIR}/lodemark.pc.in ${PROJECT_BINARY_DIR}/lodemark.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lodemark.pc DESTINATION ${pkgconfig_dir})
if(LODEMARK_STATIC_LIBRARY)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/lodemark-static.pc.in
                 ${PROJECT_BINARY_DIR}/lodemark-static.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/lodemark-static.pc DESTINATION ${pkgconfig_dir})
endif()

if(LODEMARK_BUILD_TOOLS)
  file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}
       ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR})
  set_target_properties(lodemark_command PROPERTIES INSTALL_RPATH $ORIGIN/${lib_from_bin})
  install(TARGETS lodemark_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(TARGETS lodemark_photo_codecs LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()

# `cpack` in a build folder: one Debian package of all this, which asks for the libraries it needs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lodemark)
set(CPACK_PACKAGE_VENDOR Lodemark)
set(CPACK_PACKAGE_CONTACT "the maintainers of Lodemark <maintainers@lodemark.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "position from raw GNSS and known landmarks")
set(CPACK_PACKAGE_DESCRIPTION
    "Library with a C interface, shared and static, its header, and the lodemark command, which replays
recordings through that interface.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What programs that take the static library link besides.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libopencv-dev, libsqlite3-dev, libccd-dev, libgeographiclib-dev, zlib1g-dev")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
include(CPack)
