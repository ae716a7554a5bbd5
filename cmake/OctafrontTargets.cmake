# Flags that every one of our targets shares, and the helpers that declare a wing, its rooms and its tests.

# All may become part of shared libraries, but where there are none: WebAssembly pays for each address.
set(OCTAFRONT_PIC ON)
if(EMSCRIPTEN)
  set(OCTAFRONT_PIC OFF)
endif()

add_library(octafront_flags INTERFACE)
target_compile_features(octafront_flags INTERFACE cxx_std_20)
# Contraction to fused multiply-add breaks the floating-point filters of the exact predicates. Square roots that need not set
# errno and comparisons that need not trap can use the vector units: the values of the results do not change.
target_compile_options(octafront_flags INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math -Wall -Wextra -Wshadow -Wpedantic
                                                 $<$<BOOL:${OCTAFRONT_WERROR}>:-Werror>)
# Many sources at a time are gigabytes of trees to GCC, which by its defaults tidies them over and over: an eighth of its time.
if(OCTAFRONT_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(octafront_flags INTERFACE --param=ggc-min-expand=400 --param=ggc-min-heapsize=1000000)
endif()
if(EMSCRIPTEN)
  target_compile_options(octafront_flags INTERFACE -include ${PROJECT_SOURCE_DIR}/web/old_libcxx.h)
endif()
if(OCTAFRONT_VALIDATE)
  target_compile_definitions(octafront_flags INTERFACE OCTAFRONT_VALIDATION)
endif()
if(OCTAFRONT_SANITIZE)
  target_compile_options(octafront_flags INTERFACE -fsanitize=${OCTAFRONT_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(octafront_flags INTERFACE -fsanitize=${OCTAFRONT_SANITIZE})
endif()

# Meshing itself is compiled as the build type says. What is off the hot path (LIGHT: files, doors, words, the order of the
# stages, rooms where a mesh spends less than some .2 % of its time) is compiled at -Og in a release: code as small as at -O1's
# in three quarters of the time, half of that of -O3 (docs/measured/house.md).
set(light_options $<$<CONFIG:Release>:-Og>)
# Debian's emscripten does not know that; and a page carries all of it. Without -finline-functions it takes -Os for a wish that
# templates stay calls: to clear a vector of numbers is a loop over them then, and not only off the hot path, for the linker keeps
# one copy of each.
if(EMSCRIPTEN)
  set(light_options $<$<CONFIG:Release>:-Os> $<$<CONFIG:Release>:-finline-functions>)
endif()

# octafront_precompile(TARGET OWNER): TARGET shares the precompiled headers of OWNER, which may be itself (and may name
# more). They are the standard library's, and of others' only what every wing has: good whatever we edit and link.
function(octafront_precompile target owner)
  if(OCTAFRONT_PCH AND target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory>
                              <numeric> <optional> <set> <span> <string> <string_view> <tuple> <utility> <vector> ${ARGN})
  elseif(OCTAFRONT_PCH)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

if(OCTAFRONT_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/octafront_pch.cpp CONTENT "")
  foreach(pch octafront_pch octafront_light_pch)
    add_library(${pch} OBJECT ${PROJECT_BINARY_DIR}/octafront_pch.cpp)
    set_target_properties(${pch} PROPERTIES POSITION_INDEPENDENT_CODE ${OCTAFRONT_PIC})
    target_link_libraries(${pch} PRIVATE octafront_flags fmt::fmt)
  endforeach()
  target_compile_options(octafront_light_pch PRIVATE ${light_options})
  octafront_precompile(octafront_pch octafront_pch <fmt/core.h>)
  octafront_precompile(octafront_light_pch octafront_light_pch <filesystem> <fmt/format.h> <nlohmann/json.hpp>)
endif()

# octafront_compile(TARGET [LIGHT]): what all of our libraries are compiled with.
function(octafront_compile target)
  target_link_libraries(${target} PRIVATE octafront_flags)
  if(LIGHT IN_LIST ARGN)
    target_compile_options(${target} PRIVATE ${light_options})
    octafront_precompile(${target} octafront_light_pch)
  else()
    octafront_precompile(${target} octafront_pch)
  endif()
  octafront_unity(${target})
endfunction()

# octafront_unity(TARGET SOURCES ...): TARGET is compiled many sources at a time; the SOURCES stay objects of their own.
# tests/house sees to it that no two sources of a wing give the same name to different things.
function(octafront_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${OCTAFRONT_UNITY} UNITY_BUILD_BATCH_SIZE 72)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# octafront_wing(NAME [LIGHT] [WINGS ...] [LIBS ...]): a static library of the rooms that follow. WINGS are those that the
# rows of its rooms in src/NAME/README.md name (tests/house compares).
function(octafront_wing name)
  cmake_parse_arguments(WING "LIGHT" "" "WINGS;LIBS" ${ARGN})
  set(target octafront_${name})
  add_library(${target} STATIC)
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ${OCTAFRONT_PIC})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC ${WING_LIBS})
  foreach(wing IN LISTS WING_WINGS)
    target_link_libraries(${target} PUBLIC octafront_${wing})
  endforeach()
  if(WING_LIGHT)
    octafront_compile(${target} LIGHT)
  else()
    octafront_compile(${target})
  endif()
endfunction()

# octafront_part(WING PART [LIGHT] [APART]): a part of a wing that is compiled in another way, octafront_WING_PART. APART:
# it is in the libraries that users link, not in the wing's.
function(octafront_part wing part)
  set(target octafront_${wing}_${part})
  add_library(${target} OBJECT)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${OCTAFRONT_PIC})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE fmt::fmt)
  octafront_compile(${target} ${ARGN})
  if(NOT APART IN_LIST ARGN)
    target_sources(octafront_${wing} PRIVATE $<TARGET_OBJECTS:${target}>)
  endif()
  set_property(GLOBAL APPEND PROPERTY octafront_parts_of_${wing} ${target})
endfunction()

# octafront_objects(VARIABLE WINGS ...): the objects of wings, those of their parts behind them: a function of a header that
# several objects have is linked as the first of them has it, and what is compiled for speed comes first.
function(octafront_objects variable)
  foreach(wing IN LISTS ARGN)
    get_property(of_wing GLOBAL PROPERTY octafront_parts_of_${wing})
    list(APPEND parts ${of_wing})
  endforeach()
  list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_OBJECTS:octafront_\\1>" OUTPUT_VARIABLE objects)
  list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  set(${variable} ${objects} ${parts} PARENT_SCOPE)
endfunction()

# octafront_room(WING/ROOM [LIGHT] SOURCES ...): the sources of a room, from its folder; of a wing that is one room: its own.
function(octafront_room path)
  cmake_parse_arguments(ROOM "LIGHT" "" "SOURCES" ${ARGN})
  string(REGEX MATCH "^([a-z]+)/?(.*)" path ${path})
  set(wing ${CMAKE_MATCH_1})
  set(target octafront_${wing})
  if(CMAKE_MATCH_2)
    list(TRANSFORM ROOM_SOURCES PREPEND ${CMAKE_MATCH_2}/ REGEX "^[^/]")
  endif()
  if(ROOM_LIGHT)
    set(target octafront_${wing}_light)
    if(NOT TARGET ${target})
      octafront_part(${wing} light LIGHT)
    endif()
  endif()
  target_sources(${target} PRIVATE ${ROOM_SOURCES})
endfunction()

# octafront_test(NAME SOURCES ... [WINGS ...] [LIBS ...]): a GoogleTest binary tests/NAME, linked with the wing of that
# name, if there is one, and WINGS.
function(octafront_test name)
  cmake_parse_arguments(T "" "" "SOURCES;WINGS;LIBS" ${ARGN})
  list(TRANSFORM T_WINGS PREPEND octafront_)
  if(TARGET octafront_${name})
    list(PREPEND T_WINGS octafront_${name})
  endif()
  add_executable(test_${name} ${T_SOURCES})
  target_link_libraries(test_${name} PRIVATE octafront_flags octafront_test_support GTest::gtest_main ${T_LIBS} ${T_WINGS})
  octafront_precompile(test_${name} octafront_test_support)
  octafront_unity(test_${name})
  gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600 LABELS ${name} COST ${test_cost})
endfunction()
