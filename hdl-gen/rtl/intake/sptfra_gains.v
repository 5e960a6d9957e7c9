// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Exponent, gain and offset of each taxel, from ROMs or a calibration's banks, or the same for all.
//
// Gain and offset come a cycle after the taxel's number or value. The exponent comes a cycle after its sample, with
// SHIFTS with the gain.

`default_nettype none

module sptfra_gains #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // 1: each taxel has its own; 0: these
    parameter PER_TAXEL = 0,
    parameter signed [9:0] EXPONENT = 10'sd0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    // 1: from the banks
    parameter CALIBRATED = 0,
    // 1: the exponent comes with the gain
    parameter SHIFTS = 0,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // The sample that comes in is of a taxel, the next one of the taxel after it, or of the first one
    input  wire sample_taken,
    input  wire sample_ends,
    // The same of the number, or the curve's value
    input  wire value_taken,
    input  wire value_ends,
    // To the banks and from them
    output wire [TAXEL_WIDTH-1:0] exponent_taxel,
    output wire [TAXEL_WIDTH-1:0] gain_taxel,
    input  wire [OFFSET_BITS+27:0] bank_constants,
    output wire signed [9:0] exponent,
    output wire [17:0] gain,
    output wire [OFFSET_BITS-1:0] offset
);

    generate
        if (PER_TAXEL != 0) begin : gen_per_taxel
            reg [TAXEL_WIDTH-1:0] valued;

            assign gain_taxel = valued;

            always @(posedge clock) begin
                if (value_taken) begin
                    valued <= valued + 1'b1;
                end
                if (reset || value_ends) begin
                    valued <= {TAXEL_WIDTH{1'b0}};
                end
            end

            if (SHIFTS != 0) begin : gen_one_taxel
                assign exponent_taxel = valued;
                wire _unused = &{1'b0, sample_taken, sample_ends};
            end else begin : gen_decoded
                reg [TAXEL_WIDTH-1:0] decoded;

                assign exponent_taxel = decoded;

                always @(posedge clock) begin
                    if (sample_taken) begin
                        decoded <= decoded + 1'b1;
                    end
                    if (reset || sample_ends) begin
                        decoded <= {TAXEL_WIDTH{1'b0}};
                    end
                end
            end
        end else begin : gen_shared
            assign exponent_taxel = {TAXEL_WIDTH{1'b0}};
            assign gain_taxel = {TAXEL_WIDTH{1'b0}};
            wire _unused = &{1'b0, reset, sample_taken, sample_ends, value_taken, value_ends, SHIFTS != 0};
        end
        if (PER_TAXEL == 0) begin : gen_constants
            assign exponent = EXPONENT;
            assign gain = GAIN;
            assign offset = {OFFSET_BITS{1'b0}};
            wire _unused_names = &{1'b0, clock, ROM_DIR != "", ROM_NAME != "", CALIBRATED != 0, bank_constants};
        end else if (CALIBRATED != 0) begin : gen_banks
            assign {exponent, gain, offset} = bank_constants;
            wire _unused_constants = &{1'b0, EXPONENT, GAIN, ROM_DIR != "", ROM_NAME != ""};
        end else begin : gen_roms
            wire [9:0] exponent_bits;

            assign exponent = exponent_bits;

            sptfra_rom #(
                .WIDTH         (10),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_exponents.mem"})
            ) exponents (
                .clock   (clock),
                .enable  (1'b1),
                .address (exponent_taxel),
                .data    (exponent_bits)
            );

            sptfra_rom #(
                .WIDTH         (18),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_gains.mem"})
            ) gains (
                .clock   (clock),
                .enable  (1'b1),
                .address (gain_taxel),
                .data    (gain)
            );

            sptfra_rom #(
                .WIDTH         (OFFSET_BITS),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_offsets.mem"})
            ) offsets (
                .clock   (clock),
                .enable  (1'b1),
                .address (gain_taxel),
                .data    (offset)
            );

            wire _unused_constants = &{1'b0, EXPONENT, GAIN, bank_constants};
        end
    endgenerate

endmodule

`default_nettype wire
