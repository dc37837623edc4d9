<?xml version="1.0" encoding="utf-8" ?>
<ogr:FeatureCollection
     gml:id="aFeatureCollection"
     xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:schemaLocation="http://ogr.maptools.org/ b.xsd"
     xmlns:ogr="http://ogr.maptools.org/"
     xmlns:gml="http://www.opengis.net/gml/3.2">
  <gml:boundedBy><gml:Envelope srsName="urn:ogc:def:crs:EPSG::32635"><gml:lowerCorner>500000 6700000</gml:lowerCorner><gml:upperCorner>500008 6700006</gml:upperCorner></gml:Envelope></gml:boundedBy>
                                                                                                                                                       
  <ogr:featureMember>
    <ogr:buildings gml:id="buildings.0">
      <gml:boundedBy><gml:Envelope srsName="urn:ogc:def:crs:EPSG::32635"><gml:lowerCorner>500000 6700000</gml:lowerCorner><gml:upperCorner>500008 6700006</gml:upperCorner></gml:Envelope></gml:boundedBy>
      <ogr:geometryProperty><gml:Polygon srsName="urn:ogc:def:crs:EPSG::32635" gml:id="buildings.geom.0"><gml:exterior><gml:LinearRing><gml:posList>500000 6700000 500008 6700000 500008 6700006 500000 6700006 500000 6700000</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></ogr:geometryProperty>
      <ogr:class>building</ogr:class>
    </ogr:buildings>
  </ogr:featureMember>
</ogr:FeatureCollection>
