# SPDX-License-Identifier: MIT
# Embeds the shader sources in the library as text, under their paths below src/. The C++ file that holds them is made
# in the build folder and made again whenever a shader changes. This file is both the function that CMakeLists.txt calls
# and the script that the build runs.

# talus_embed_kernels(<out_var> <folder>... [FUNCTION <qualified name> HEADER <header that declares it>]): every *.glsl
# below the folders of the current source folder; out_var names the made C++ file, which defines the function, by default
# embedded_files() of device/gl/kernel_source.h.
function(talus_embed_kernels out_var)
    cmake_parse_arguments(PARSE_ARGV 1 embed "" "FUNCTION;HEADER" "")
    if(NOT embed_FUNCTION)
        set(embed_FUNCTION talus::engine::embedded_files)
        set(embed_HEADER device/gl/kernel_source.h)
    endif()
    set(files)
    foreach(folder IN LISTS embed_UNPARSED_ARGUMENTS)
        file(GLOB_RECURSE found RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS
             "${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.glsl")
        list(APPEND files ${found})
    endforeach()
    list(SORT files)

    set(inputs ${files})
    list(TRANSFORM inputs PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
    set(output "${CMAKE_CURRENT_BINARY_DIR}/embedded_kernels.cpp")
    set(script "${CMAKE_CURRENT_FUNCTION_LIST_FILE}")
    add_custom_command(
        OUTPUT "${output}"
        COMMAND "${CMAKE_COMMAND}" "-Droot=${CMAKE_CURRENT_SOURCE_DIR}" "-Dfiles=${files}" "-Doutput=${output}"
                "-Dfunction=${embed_FUNCTION}" "-Dheader=${embed_HEADER}" -P "${script}"
        DEPENDS ${inputs} "${script}"
        COMMENT "Embedding the kernels"
        VERBATIM)
    set(${out_var} "${output}" PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
    set(entries "")
    foreach(path IN LISTS files)
        file(READ "${root}/${path}" text)
        if(text MATCHES "\\)talus_glsl\"")
            message(FATAL_ERROR "${path}: holds )talus_glsl\", which ends the C++ literal that it is embedded in")
        endif()
        string(APPEND entries "    {\"${path}\", R\"talus_glsl(${text})talus_glsl\"sv},\n")
    endforeach()
    file(WRITE "${output}.new"
        "// Made by cmake/embed_kernels.cmake from the shaders below ${root}.\n"
        "#include \"${header}\"\n\n"
        "using namespace std::string_view_literals; // whose length no compiler has to count\n\n"
        "static constexpr talus::engine::ShaderFile k_files[] = {\n${entries}};\n\n"
        "std::span<const talus::engine::ShaderFile> ${function}() { return k_files; }\n")
    file(RENAME "${output}.new" "${output}")
endif()
