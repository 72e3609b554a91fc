"""What a case may claim; each kind says which tasks it needs and judges their answers.

- ``declared``: what every claim states: tolerance, reason, origin of the expected number
- ``exact``, ``printed``, ``agreement``, ``field_agreement``, ``order``, ``approach``, ``even_accuracy``
- ``own_laws``: what each answer keeps by itself; ``changed_scenes``: what changing the scene must do
"""
