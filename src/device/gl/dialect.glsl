// SPDX-License-Identifier: MIT
// Opens every compute shader: lets GLSL read the *.shared.glsl files, and holds what every kernel needs.
#define inline

uniform uvec4 args; // what the launch says; each kernel's head gives the meaning

// Number of this work group among all of the launch.
uint group_index()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// Number of this invocation among all of the launch; large launches use two dimensions of groups. A macro, because GLSL
// knows the size of a group only after the kernel's own layout line.
#define item_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
