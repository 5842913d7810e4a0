// SPDX-License-Identifier: MIT
// The forest of islands. Before this file the kernel declares Islands, coherent where others change it meanwhile.

// The root of a body's tree. On the way each body is led to its grandparent: an invocation that still sees the parent
// finds the same root, later.
uint root_of(uint body)
{
    uint parent = islands[body];
    while (parent != body) {
        uint grandparent = islands[parent];
        if (grandparent != parent) islands[body] = grandparent;
        body = parent;
        parent = grandparent;
    }
    return body;
}
