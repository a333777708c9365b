"""The physics: scalars in, scalars out.  Plain functions, one source for every engine, number type and the replay."""
