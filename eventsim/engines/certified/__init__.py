"""The certified engine: the reference loop on ball arithmetic, where a comparison is answered or the precision is doubled."""
