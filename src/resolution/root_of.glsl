// SPDX-License-Identifier: MIT
// The root of the tree that a body hangs in, which names its island. Changes nothing on its way: others may hang what it passes
// elsewhere meanwhile, from the same root. Before this file the kernel declares Islands.

uint root_of(uint body)
{
    uint parent = islands[body];
    while (parent != body) {
        body = parent;
        parent = islands[body];
    }
    return body;
}
