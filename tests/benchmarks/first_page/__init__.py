"""What a person sees in the first minute of the theatre's page, in a browser without a graphics card."""
