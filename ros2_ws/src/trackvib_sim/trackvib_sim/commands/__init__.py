"""What the verbs of the command line do; options are checked here, the work lies in the packages below."""
