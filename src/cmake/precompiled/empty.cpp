// The source of a target that has precompiled headers only.
