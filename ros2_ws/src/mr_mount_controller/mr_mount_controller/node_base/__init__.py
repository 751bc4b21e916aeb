"""What every node needs: its base, parameters, names of topics, quality of service, messages as bytes."""
