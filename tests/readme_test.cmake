# The first program of README.md, compiled as any program outside of Talus is: it sees the public headers and links the
# library. Read here, so that what is compiled is what stands there.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/README.md")
file(READ "${PROJECT_SOURCE_DIR}/README.md" readme)
string(FIND "${readme}" "\n```cpp\n" begin)
if(begin EQUAL -1)
    message(FATAL_ERROR "README.md: has no program, a block that begins with ```cpp")
endif()
math(EXPR begin "${begin} + 8")
string(SUBSTRING "${readme}" ${begin} -1 program)
string(FIND "${program}" "\n```" end)
math(EXPR end "${end} + 1")
string(SUBSTRING "${program}" 0 ${end} program)
file(CONFIGURE OUTPUT readme_program.cpp CONTENT "${program}" @ONLY)

add_executable(talus_readme_program "${CMAKE_CURRENT_BINARY_DIR}/readme_program.cpp")
target_link_libraries(talus_readme_program PRIVATE talus::talus)

talus_test(readme)
add_dependencies(readme_test talus_program talus_readme_program)
target_compile_definitions(readme_test PRIVATE
    TALUS_COMPILER="${CMAKE_CXX_COMPILER}"
    TALUS_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER}"
    TALUS_PROGRAM_FILE="$<TARGET_FILE:talus_program>"
    TALUS_README_PROGRAM_FILE="$<TARGET_FILE:talus_readme_program>")
talus_run(readme docs)
