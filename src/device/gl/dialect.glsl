// SPDX-License-Identifier: MIT
// Opens every compute shader: lets GLSL read the *.shared.glsl files, and holds what every kernel needs.
#define inline

// What formulas choose by, where the CPU runs them on several items side by side and where they have to be quick. Both values are
// made before the choice; what stands in ?: is inside a branch for NVIDIA's compiler, which pays only where it saves a load or much
// arithmetic (docs/performance.md).
float choose(bool condition, float yes, float no) { return mix(no, yes, condition); }
uint choose(bool condition, uint yes, uint no) { return mix(no, yes, condition); }
vec3 choose(bool condition, vec3 yes, vec3 no) { return mix(no, yes, bvec3(condition)); }
vec4 choose(bool condition, vec4 yes, vec4 no) { return mix(no, yes, bvec4(condition)); }
#define choose_active(condition, yes, no) (yes) // where the condition is known to hold
#define holds_here(condition) (true)              // the same, of what a loop or a branch has asked already
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
