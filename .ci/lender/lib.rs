//! Nothing: the manifest beside it is what is asked for.
