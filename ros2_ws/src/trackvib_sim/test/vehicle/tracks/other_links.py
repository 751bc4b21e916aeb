"""The vehicle on tracks of other links."""

# links a side, pitch and teeth: as long and, on the sprocket, as large as the shipped ones to 2 %
LINKS = ((120, 0.115, 16), (100, 0.138, 13), (150, 0.092, 20))


def with_links(vehicle, links, pitch, teeth):
    """Return the vehicle with tracks of as much mass and elasticity a metre, and with other teeth."""
    tracks, share = vehicle.tracks, pitch / vehicle.tracks.pitch
    other = {
        "links": [float(links)] * 2,
        "pitch": pitch,
        "shoe_mass": share * tracks.shoe_mass,
        "link_stiffness": tracks.link_stiffness / share,
        "link_damping": tracks.link_damping / share,
    }
    sprockets = vehicle.sprocket_teeth.model_copy(update={"teeth": float(teeth)})
    return vehicle.model_copy(update={"tracks": tracks.model_copy(update=other), "sprocket_teeth": sprockets})
