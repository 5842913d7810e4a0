// SPDX-License-Identifier: MIT
// Opens every compute shader: lets GLSL read the *.shared.glsl files, and holds what every kernel needs.
#define inline

// Formulas choose by these instead of by ?: and if where the CPU runs them on several items side by side.
#define choose(condition, yes, no) ((condition) ? (yes) : (no))
#define choose_active(condition, yes, no) (yes) // where the condition is known to hold
#define all_lanes(condition) (condition)
#define any_lane(condition) (condition)

uniform uvec4 args; // what the launch says; each kernel's head gives the meaning

// Number of this work group among all of the launch.
uint group_index()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// Number of this invocation among all of the launch; large launches use two dimensions of groups. A macro, because GLSL
// knows the size of a group only after the kernel's own layout line.
#define item_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
