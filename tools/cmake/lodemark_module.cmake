# What every target of ours compiles with: strict warnings, and arithmetic that gives the same bits
# on every processor.
add_library(lodemark_flags INTERFACE)
target_compile_features(lodemark_flags INTERFACE cxx_std_20)
target_compile_options(
  lodemark_flags
  INTERFACE -ffp-contract=off
            -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            $<$<BOOL:${LODEMARK_WARNINGS_AS_ERRORS}>:-Werror>
            $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
            $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
            $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>
            # g++ 12 sees overlaps in std::string concatenation that are not there (GCC PR 105651).
            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
            # And unset values in Eigen's matrices of bounded size, which are set.
            $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
            # What nobody calls is left out of the library.
            $<$<CONFIG:Release>:-ffunction-sections>
            $<$<CONFIG:Release>:-fdata-sections>)
target_include_directories(lodemark_flags INTERFACE ${CMAKE_SOURCE_DIR}
                                                    ${CMAKE_SOURCE_DIR}/core/include)

# One folder, one target: lodemark_module(gnss SOURCES a.cc b.cc DEPENDS base geo LINKS Eigen3::Eigen)
# makes the static library lodemark_gnss. PRIVATE_LINKS are libraries that stay in the .cc files;
# SMALL are sources where nothing is slow, so that a release makes them small.
function(lodemark_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;SMALL;DEPENDS;LINKS;PRIVATE_LINKS" ${ARGN})
  if(ARG_SOURCES OR ARG_SMALL)
    set_source_files_properties(${ARG_SMALL} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-Os>)
    add_library(lodemark_${name} STATIC ${ARG_SOURCES} ${ARG_SMALL})
    set(scope PUBLIC)
    target_link_libraries(lodemark_${name} PRIVATE ${ARG_PRIVATE_LINKS})
    set_target_properties(lodemark_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden
                                                      VISIBILITY_INLINES_HIDDEN ON)
  else()
    add_library(lodemark_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(lodemark_${name} ${scope} lodemark_flags ${ARG_LINKS})
  foreach(module IN LISTS ARG_DEPENDS)
    target_link_libraries(lodemark_${name} ${scope} lodemark_${module})
  endforeach()
endfunction()

# lodemark_unit_test(gnss SOURCES a_test.cc DEPENDS logs) makes the test program gnss_test of the
# module and registers its cases with CTest. Suites with Recorded in their name read real recordings, see
# test/recordings.h, and carry the label recorded.
function(lodemark_unit_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LINKS" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE lodemark_${name} GTest::gtest_main GTest::gmock
                                             ${ARG_LINKS})
  foreach(module IN LISTS ARG_DEPENDS)
    target_link_libraries(${name}_test PRIVATE lodemark_${module})
  endforeach()
  target_compile_definitions(
    ${name}_test PRIVATE LODEMARK_DATA_DEFAULT="${PROJECT_SOURCE_DIR}/../shared/data")
  gtest_discover_tests(${name}_test TEST_PREFIX ${name}. TEST_FILTER -*Recorded*
                       DISCOVERY_TIMEOUT 120)
  gtest_discover_tests(${name}_test TEST_PREFIX ${name}. TEST_FILTER *Recorded*
                       TEST_LIST ${name}_recorded_tests DISCOVERY_TIMEOUT 120
                       PROPERTIES LABELS recorded)
endfunction()
