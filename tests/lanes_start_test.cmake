# What is compiled for a set of instructions may run nothing when a program starts, as that may be on a machine without them.
# cmake -D OBJDUMP=... -D "OBJECTS=files" -P this
foreach(object IN LISTS OBJECTS)
    execute_process(COMMAND "${OBJDUMP}" --section-headers "${object}" OUTPUT_VARIABLE sections COMMAND_ERROR_IS_FATAL ANY)
    if(sections MATCHES "\\.(init_array|ctors)")
        message(SEND_ERROR "${object} computes something when the program starts: a constant that is no constant expression")
    endif()
endforeach()
