"""What is asked of the unfolded net where a limit has ended the exploration of all markings. See `look.look`."""
