# aircut_library(NAME DEPENDS … LIBS … PRIVATE_LIBS …): all of src/NAME/**.cpp as one static library.
# aircut_program(NAME FOLDER … …):                      the same as a program in BUILD/bin.
# aircut_tests(NAME DEPENDS … LABELS …):                 all of tests/NAME/*_test.cpp as one GoogleTest program.

add_library(aircut_options INTERFACE)
target_compile_features(aircut_options INTERFACE cxx_std_20)
target_include_directories(aircut_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
target_compile_options(aircut_options INTERFACE -Wall -Wextra -Wconversion -Wshadow
  $<$<BOOL:${AIRCUT_WERROR}>:-Werror>)
# g++ 12 warns falsely about std::string's operator+ in optimised builds (GCC bug 105651).
target_compile_options(aircut_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# The same bits with every compiler and option: no fused multiply-add behind our back.
target_compile_options(aircut_options INTERFACE -ffp-contract=off)

# Third-party headers are not ours to lint.
function(aircut_link_system target scope)
  foreach(lib IN LISTS ARGN)
    target_link_libraries(${target} ${scope} ${lib})
    if(TARGET ${lib})
      get_target_property(dirs ${lib} INTERFACE_INCLUDE_DIRECTORIES)
      if(dirs)
        target_include_directories(${target} SYSTEM ${scope} ${dirs})
      endif()
    endif()
  endforeach()
endfunction()

function(aircut_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBS;PRIVATE_LIBS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/*.cpp)
  if(NOT sources)
    add_library(aircut_${name} INTERFACE)
    foreach(dep IN LISTS ARG_DEPENDS)
      target_link_libraries(aircut_${name} INTERFACE aircut_${dep})
    endforeach()
    return()
  endif()
  add_library(aircut_${name} STATIC ${sources})
  target_link_libraries(aircut_${name} PUBLIC aircut_options fmt::fmt Threads::Threads)
  aircut_link_system(aircut_${name} PUBLIC ${ARG_LIBS})
  aircut_link_system(aircut_${name} PRIVATE ${ARG_PRIVATE_LIBS})
  foreach(dep IN LISTS ARG_DEPENDS)
    target_link_libraries(aircut_${name} PUBLIC aircut_${dep})
  endforeach()
endfunction()

function(aircut_program name)
  cmake_parse_arguments(ARG "" "FOLDER" "DEPENDS;PRIVATE_LIBS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${ARG_FOLDER}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE aircut_options)
  target_compile_definitions(${name} PRIVATE AIRCUT_VERSION="${PROJECT_VERSION}")
  aircut_link_system(${name} PRIVATE ${ARG_PRIVATE_LIBS})
  foreach(dep IN LISTS ARG_DEPENDS)
    target_link_libraries(${name} PRIVATE aircut_${dep})
  endforeach()
endfunction()

function(aircut_tests name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBS;LABELS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${name}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name}_tests ${sources})
  # Tests run in the source folder; paths from there keep objects the same wherever the clone is,
  # so that ccache finds them.
  file(RELATIVE_PATH binary_dir ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR})
  target_compile_definitions(${name}_tests PRIVATE
    AIRCUT_SOURCE_DIR="." AIRCUT_BINARY_DIR="${binary_dir}")
  target_include_directories(${name}_tests PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  aircut_link_system(${name}_tests PRIVATE GTest::gtest_main ${ARG_LIBS})
  foreach(dep IN LISTS ARG_DEPENDS)
    target_link_libraries(${name}_tests PRIVATE aircut_${dep})
  endforeach()
  include(GoogleTest)
  gtest_discover_tests(${name}_tests DISCOVERY_TIMEOUT 60
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} PROPERTIES LABELS "${name};${ARG_LABELS}")
endfunction()
