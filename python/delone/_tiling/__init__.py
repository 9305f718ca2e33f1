"""What triangulations of every dimension share: classes, measures, location, archives."""
