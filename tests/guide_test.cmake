# Every piece of C++ in docs/guide, compiled as a function of its own and run by guide_test.cpp. Read here, so that
# what is compiled is what stands there. A block that begins with ```cpp no_run is compiled only.
file(GLOB guide_pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/guide/*.md")
list(SORT guide_pages)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${guide_pages})
set(guide_functions "")
set(guide_table "")
set(guide_count 0)
foreach(page IN LISTS guide_pages)
    cmake_path(GET page FILENAME page_name)
    file(READ "${page}" rest)
    string(FIND "${rest}" "\n```cpp" begin)
    while(NOT begin EQUAL -1)
        math(EXPR begin "${begin} + 7")
        string(SUBSTRING "${rest}" ${begin} -1 rest)
        string(FIND "${rest}" "\n" end_of_line)
        string(SUBSTRING "${rest}" 0 ${end_of_line} marks)
        string(FIND "${rest}" "\n```" end)
        math(EXPR length "${end} - ${end_of_line}")
        string(SUBSTRING "${rest}" ${end_of_line} ${length} code)
        math(EXPR guide_count "${guide_count} + 1")
        string(APPEND guide_functions "void example_${guide_count}() {${code}\n}\n\n")
        if(marks MATCHES "no_run")
            string(APPEND guide_table "    {\"${page_name}\", nullptr, example_${guide_count}},\n")
        else()
            string(APPEND guide_table "    {\"${page_name}\", example_${guide_count}, nullptr},\n")
        endif()
        math(EXPR end "${end} + 4")
        string(SUBSTRING "${rest}" ${end} -1 rest)
        string(FIND "${rest}" "\n```cpp" begin)
    endwhile()
endforeach()
set(guide_source "${CMAKE_CURRENT_BINARY_DIR}/guide_examples.cpp")
set(guide_text "// Made by tests/guide_test.cmake from docs/guide.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <talus/talus.h>

#include \"tests/guide_examples.h\"

namespace {

${guide_functions}const talus::tests::GuideExample k_examples[]{
${guide_table}};

} // namespace

std::span<const talus::tests::GuideExample> talus::tests::guide_examples() { return k_examples; }
")
file(GENERATE OUTPUT "${guide_source}" CONTENT "${guide_text}")

talus_test(guide)
target_sources(guide_test PRIVATE "${guide_source}")
talus_run(guide docs)
