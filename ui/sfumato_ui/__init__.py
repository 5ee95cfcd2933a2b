"""The window of Sfumato (Qt through qtpy).

``app.run`` starts it; ``window.MainWindow`` holds it together and says how. One concept a file: `viewport` (the
picture and the hand), `worker` (the render thread), `refinement` (the frames of a still picture), `stills` (pictures
that were finished a moment ago), `driver` (what is asked of it, when), `editing` (the one door to the document),
`files` (opening and saving), `panels` (the tabs), `dial`, `sliders`, `generated` (controls made from declared
parameters), `theme`. `light_moves` and `camera_moves` are plain mathematics.
"""
