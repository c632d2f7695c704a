# liblodemark.a: everything of ours in one object that shows lodemark_* alone, from the objects of the shared
# library. So it cannot clash with a program's own Eigen, compiled otherwise, or with anything else.
# Needs the GNU linker's kind of partial linking, hence ELF.
set(elf ON)
if(WIN32
   OR APPLE
   OR ANDROID)
  set(elf OFF)
endif()
option(LODEMARK_STATIC_LIBRARY "Make liblodemark.a, too" ${elf})

# What a program links besides, in the order of the linker: for the CMake package and pkg-config.
set(LODEMARK_STATIC_NEEDS
    opencv_features2d
    opencv_imgproc
    opencv_core
    sqlite3
    ccd
    GeographicLib
    z
    stdc++
    m)
list(TRANSFORM LODEMARK_STATIC_NEEDS PREPEND -l OUTPUT_VARIABLE LODEMARK_STATIC_FLAGS)
list(JOIN LODEMARK_STATIC_FLAGS " " LODEMARK_STATIC_FLAGS)

if(NOT LODEMARK_STATIC_LIBRARY)
  return()
endif()

set(modules
    session
    logs
    fusion
    vision
    map
    sightline
    resection
    camera
    adjustment
    gnss
    geo
    base)
list(TRANSFORM modules PREPEND lodemark_)
list(TRANSFORM modules REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
set(static_library ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/liblodemark.a)
set(joined ${CMAKE_CURRENT_BINARY_DIR}/lodemark.o)
add_custom_command(
  OUTPUT ${static_library}
  COMMAND
    ${CMAKE_CXX_COMPILER} -r -nostdlib -Wl,--force-group-allocation -o ${joined}
    $<TARGET_OBJECTS:lodemark_capi> -Wl,--start-group ${archives} -Wl,--end-group
  COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=lodemark_*
          $<$<CONFIG:Release>:--strip-unneeded> ${joined}
  COMMAND ${CMAKE_COMMAND} -E rm -f ${static_library}
  COMMAND ${CMAKE_AR} qcs ${static_library} ${joined}
  COMMAND ${CMAKE_COMMAND} -E rm -f ${joined}
  DEPENDS $<TARGET_OBJECTS:lodemark_capi> ${modules}
  COMMENT "Joining liblodemark.a"
  COMMAND_EXPAND_LISTS VERBATIM)
add_custom_target(lodemark_static ALL DEPENDS ${static_library})
