// Nothing of its own: the headers that reading, reporting and the commands include are precompiled with this file, once
// for all of them.
